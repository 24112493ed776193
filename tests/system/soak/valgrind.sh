#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Runs both ends of a stream under valgrind's memcheck. Fails if it finds an invalid access, a use
# of uninitialised memory, or a leak of a function of this project. The sensor is a small one,
# because valgrind makes the pipelines about thirty times slower.
set -euo pipefail
command -v valgrind >/dev/null || { echo "Install valgrind." >&2; exit 1; }
source "$(dirname "$0")/../../../pipelines/environment.sh"
port=${PORT:-5484}
seconds=${1:-20}
work=$(mktemp -d)
trap 'kill ${receiver:-} 2>/dev/null || true; rm -rf "$work"' EXIT
export G_SLICE=always-malloc GST_REGISTRY_FORK=no LIDAR_SRTP_KEY
LIDAR_SRTP_KEY=$(printf '5a%.0s' {1..30})
# Makes the registry without valgrind.
gst-inspect-1.0 screamsink >/dev/null

# check NAME PIPELINE...: runs the pipeline under valgrind, and writes the findings to $work/NAME.
check() {
  local name=$1
  shift
  exec valgrind --quiet --leak-check=full --show-leak-kinds=definite --num-callers=40 --log-file="$work/$name" \
    gst-launch-1.0 -q -e "$@" >"$work/$name.out" 2>&1
}
net="port=$port srtp-key=env:LIDAR_SRTP_KEY"
check receiver screamsrc $net ! rtplidardepay ! dracodec ! scanassembler ! filesink location="$work/scans" sync=false async=false &
receiver=$!
sleep 8
check sender lidartestsrc is-live=true model=os0-32 mode=512x10 num-buffers=$((seconds * 40)) slices-per-scan=4 ! \
  dracoenc max-error=0.05 ! rtplidarpay ! screamsink $net &
wait $!
wait $receiver

[ -s "$work/scans" ] || { cat "$work"/*.out; echo "FAILED: no scan came out" >&2; exit 1; }
echo "$(stat -c %s "$work/scans") bytes of scans came out"
status=0
for name in sender receiver; do
  # Each record in the output ends with an empty line. A leak counts only if one of its stack frames
  # is in a library of this project.
  awk -v RS='\n==[0-9]+== \n' '!/definitely lost/ || /(libgstlidar|libgstrtplidar|libgstecnudp|libgstouster)/' "$work/$name" >"$work/$name.found"
  echo "$name: $(grep -c 'definitely lost' "$work/$name" || true) leaks in libraries of others, $(grep -cE 'Invalid|uninitialised|definitely lost' "$work/$name.found" || true) errors of ours"
  if grep -qE 'Invalid|uninitialised|definitely lost|Mismatched' "$work/$name.found"; then cat "$work/$name.found"; status=1; fi
  if grep -E 'ERROR' "$work/$name.out"; then status=1; fi
done
exit $status
