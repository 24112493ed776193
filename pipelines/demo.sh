#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# The demo: installs, builds, and streams LiDAR through a changing L4S bottleneck, measured at both ends.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
build=${BUILD_DIR:-$root/build}

# say TEXT: prints the progress to standard error, because the results go to standard output.
say() { echo "demo: $*" >&2; }

build_all() {
  local log=$build.log
  [ -f "$build/build.ninja" ] || { say "configuring (log: $log)"; meson setup "$build" "$root" >"$log" 2>&1; } ||
    { tail -20 "$log" >&2; exit 1; }
  say "building"
  if [ -t 2 ]; then ninja -C "$build" demo >&2; return; fi  # a terminal shows ninja's progress
  ninja -C "$build" demo >"$log" 2>&1 || { grep -A8 -E 'FAILED|error:' "$log" | head -40 >&2; exit 1; }
}

usage() {
  cat <<'EOF'
Usage: pipelines/demo.sh [--no-install] [--no-build] [options of the stream]

Streams LiDAR: sender -> lidar-link -> receiver, three processes over UDP sockets, through a link whose capacity
changes, and compares what arrives with what was sent. Exit code 0: every guarantee held; 1: one did
not, or the run failed; 2: wrong use; 3: all held, but not half of what the link could carry arrived.

  pipelines/demo.sh                               a synthetic drive, capacity in steps
  pipelines/demo.sh --drive                       the same over a 5G-like link with handover gaps
  pipelines/demo.sh --drive --pcap drive.pcap     a capture, over such a link
  pipelines/demo.sh --scans velodyne/             a folder of scans: PCD, PLY, LAS, KITTI
  pipelines/demo.sh --model mid-360               a sensor of another maker

  --no-install   do not install Debian packages
  --no-build     take build/ as it is

EOF
}

install=yes
compile=yes
help=no
arguments=()
for argument in "$@"; do
  case $argument in
    --no-install) install=no ;;
    --no-build) compile=no ;;
    -h | --help) help=yes ;;
    *) arguments+=("$argument") ;;
  esac
done

if [ "$help" = yes ]; then
  usage
  [ ! -x "$build/src/tools/lidar-demo" ] || "$build/src/tools/lidar-demo" run --help | sed -n '/^options/I,$p' | grep -v -- --help
  exit 0
fi
[ "$install" = no ] || "$root/tests/install.sh" >&2
[ "$compile" = no ] || build_all

source "$root/pipelines/environment.sh"
exec "$build/src/tools/lidar-demo" run "${arguments[@]}"
