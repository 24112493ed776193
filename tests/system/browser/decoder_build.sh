#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Checks that the committed decoder is equal to a decoder that is built from its sources.
set -euo pipefail
decoder=$(cd "$(dirname "$0")/../../../ext/web/decoder" && pwd)
[ -d /usr/include/wasm32-wasi/c++ ] || { echo "tests/run.sh --suite browser installs what is missing"; exit 77; }
built=$(mktemp)
trap 'rm -f "$built"' EXIT
"$decoder/build.sh" "$built"
cmp "$built" "$decoder/lidar_decoder.wasm"
