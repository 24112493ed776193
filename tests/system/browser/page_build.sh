#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Checks that the committed page is equal to a page that is built from its sources.
set -euo pipefail
page=$(cd "$(dirname "$0")/../../../ext/web/page" && pwd)
[ -d "$page/node_modules" ] || { echo "run npm ci in ext/web/page first"; exit 77; }
built=$(mktemp -d)
trap 'rm -rf "$built"' EXIT
cd "$page"
npx vite build --logLevel warn --outDir "$built" --emptyOutDir
diff -rq dist "$built"
