#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Runs a test file with Node.js: node_test.sh FILE
set -euo pipefail
cd "$(dirname "$0")"
[ -d node_modules ] && [ -x "${CHROMIUM:-/usr/bin/chromium}" ] || { echo "tests/run.sh --suite browser installs what is missing"; exit 77; }
exec node --test "$1"
