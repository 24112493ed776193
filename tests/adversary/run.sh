#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Builds what is attacked, and attacks it for as long as is wanted.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${BUILD_DIR:-$root/build}

minutes=0
seed=$RANDOM
only=()
while [ $# -gt 0 ]; do
  case $1 in
    --minutes) minutes=$2; shift ;;
    --seed) seed=$2; shift ;;
    --only) only=(--only "$2"); shift ;;
    *) echo "Usage: tests/adversary/run.sh [--minutes N] [--seed S] [--only PART_OF_A_NAME]
BUILD_DIR names the build, build-asan for example." >&2
       [ "$1" = --help ] && exit 0 || exit 2 ;;
  esac
  shift
done

[ -f "$build/build.ninja" ] || meson setup "$build" "$root" >"$build.log" 2>&1
ninja -C "$build" attacked >"$build.log" 2>&1 || { tail -20 "$build.log" >&2; exit 1; }
sanitized=()
[ "$(meson introspect "$build" --buildoptions | jq -r '.[] | select(.name == "b_sanitize") | .value')" = none ] ||
  sanitized=(--sanitized)
plugins=$(find "$build/gst" "$build/ext" -name 'libgst*.so' -printf '%h\n' | sort -u | paste -sd:)
export GST_PLUGIN_PATH_1_0=$plugins GST_REGISTRY=$build/adversary-registry.bin GST_REGISTRY_FORK=no
exec "$root/tests/adversary/adversary.py" --victim "$build/tests/adversary/victim" --minutes "$minutes" --seed "$seed" \
  "${sanitized[@]}" "${only[@]}"
