#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# run_demo.sh FOLDER FILTER [options of the demo]: runs the demo from the build tree, and fails if a
# guarantee of the demo is broken. Exit code 3 is accepted beside 0, because little may arrive on a
# busy machine. The jq FILTER must be true for summary.json. It can use stats.json as $stats[0].
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
folder=$1
filter=$2
shift 2
rm -rf "$folder"

status=0
BUILD_DIR=$MESON_BUILD_ROOT "$root/pipelines/demo.sh" --no-install --no-build --output "$folder" "$@" | tee "$folder.log" || status=$?
if [ "$status" != 0 ] && [ "$status" != 3 ]; then
  echo "demo.sh ended with $status" >&2
  tail -n 20 "$folder"/*.log >&2
  exit 1
fi
jq -e --slurpfile stats "$folder/stats.json" "$filter" "$folder/summary.json" >/dev/null || {
  echo "not true for summary.json: $filter" >&2
  jq . "$folder/summary.json" >&2
  exit 1
}
