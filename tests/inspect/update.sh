#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Writes docs/plugins_cache.json from the plugins in build/, or in the folder that BUILD_DIR names.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
. "$root/pipelines/environment.sh"
ninja -C "$build" >/dev/null
exec "$(dirname "$0")/inspect_test.sh" "$build/tests/inspect/lidar-inspect" --update
