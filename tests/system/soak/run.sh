#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Sends an encrypted stream for hours through a link that follows a drive with gaps and has random
# faults. Checks the stream once per minute, and prints a line.
set -euo pipefail
root=$(cd "$(dirname "$0")/../../.." && pwd)
build=$(realpath -m "${BUILD_DIR:-$root/build}")

minutes=0
seed=$RANDOM
cipher=srtp
gaps=yes
while [ $# -gt 0 ]; do
  case $1 in
    --hours) minutes=$(awk "BEGIN { print int($2 * 60) }"); shift ;;
    --minutes) minutes=$2; shift ;;
    --seed) seed=$2; shift ;;
    --no-srtp) cipher=plain ;;
    --no-gaps) gaps=no ;;
    *) echo "Usage: tests/system/soak/run.sh --hours N | --minutes N [--seed S] [--no-srtp] [--no-gaps]" >&2
       [ "$1" = --help ] && exit 0 || exit 2 ;;
  esac
  shift
done
[ "$minutes" -gt 0 ] || { echo "Say how long: --hours N or --minutes N." >&2; exit 2; }

[ -f "$build/build.ninja" ] || meson setup "$build" "$root" >"$build.log" 2>&1
ninja -C "$build" endurance >"$build.log" 2>&1 || { tail -20 "$build.log" >&2; exit 1; }
plugins=$(find "$build/gst" "$build/ext" -name 'libgst*.so' -printf '%h\n' | sort -u | paste -sd:)
export GST_PLUGIN_PATH_1_0=$plugins GST_REGISTRY=$build/soak-registry.bin
link=()
if [ "$gaps" = yes ]; then
  # The trace is a drive with handovers and with cell edges. It repeats every ten minutes.
  trace=$(mktemp)
  trap 'rm -f "$trace"' EXIT
  "$build/src/tools/lidar-trace" --duration 600 --rate 2 --seed "$seed" >"$trace"
  link=("$build/src/tools/lidar-link" "$trace")
fi
echo "seed $seed"
"$build/tests/system/faults/soak" "$minutes" "$seed" "$cipher" "${link[@]}"
