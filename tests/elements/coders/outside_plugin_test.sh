#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copies the folder docs/examples/coder and builds it with the installed headers, library and
# pkg-config file. Then sends its slices over each transport to its decoder. No element between
# encoder and decoder knows this coder.
# Usage: outside_plugin_test.sh SOURCE_ROOT BUILD_ROOT; LIDAR_EDGE is the path of that program.
set -euo pipefail
source=$1
build=$2
. "$source/tests/support/installed.sh"
# shellcheck disable=SC2154  # of installed.sh
cd "$work"

cp -r "$source/docs/examples/coder" coder
if ! { PKG_CONFIG_PATH=$work meson setup -Dwerror=true coder/build coder && ninja -C coder/build; } >log 2>&1; then
  cat log >&2
  exit 1
fi
echo '#include <gst/lidar/gstlidarcloudinfo.h>
#include <gst/lidar/gstlidardecoder.h>
#include <gst/lidar/gstlidarencoder.h>' >header.c
# shellcheck disable=SC2086,SC2154
cc -std=c99 -Wall -Wextra -Wno-unused-parameter -Werror -fsyntax-only header.c $flags

GST_PLUGIN_PATH_1_0=$work/coder/build:$(find "$build/gst" "$build/ext" -name 'libgst*.so' -printf '%h\n' | sort -u | paste -sd:)
export GST_PLUGIN_PATH_1_0
gst-inspect-1.0 exampleenc >inspected
for property in bitrate max-error min-bitrate degradation-preference error-check stats stats-interval; do
  grep -q "^  $property *:" inspected || { echo "exampleenc has no $property" >&2; exit 1; }
done

play=(timeout 60 gst-launch-1.0 -q)
mapfile -t ports < <(python3 "$source/tests/support/ports.py" 1 1)
# Decodes 40 slices without a transport. The decoder outputs every point.
encoder='lidartestsrc model=os1-32 mode=512x10 num-buffers=40 ! exampleenc max-error=0.02'
decoder='exampledec ! filesink async=false location'
# shellcheck disable=SC2086
"${play[@]}" $encoder ! $decoder=direct
[ "$(stat -c %s direct)" -gt 500000 ] || { echo "the decoder gave too little" >&2; exit 1; }

# Compares the output after a transport with the output without one. Every slice must have arrived.
# A point may differ by up to twice the bound, because congestion control may choose finer or
# coarser steps.
same() {
  python3 - direct "$1" <<'END' || { echo "$1 is not what was sent" >&2; exit 1; }
import array, sys
direct, through = (array.array("f", open(path, "rb").read()) for path in sys.argv[1:])
assert len(direct) == len(through), (len(direct), len(through))
assert max(abs(a - b) for a, b in zip(direct, through)) < 2 * 0.02
END
}

children=()
trap 'kill "${children[@]}" 2>/dev/null; wait; rm -rf "$work"' EXIT
# start CHECK PROGRAM...: starts the program in the background, and waits until CHECK succeeds.
start() {
  "${@:2}" >output 2>&1 &
  children+=($!)
  until eval "$1"; do kill -0 $! || { cat output >&2; exit 1; }; sleep 0.05; done
}

# The source is not live, so it waits while the sender's queue is full. No slice is skipped, because
# none waits longer than max-queue-delay.
send="rtplidarpay ! screamsink host=127.0.0.1 port=${ports[0]} start-bitrate=20000000 max-queue-delay=30000000000"
bound() { grep -qs "$(printf ':%04X ' "${ports[0]}")" /proc/net/udp /proc/net/udp6; }
# shellcheck disable=SC2086
start bound "${play[@]}" screamsrc address=127.0.0.1 port="${ports[0]}" eos-on-bye=true ! rtplidardepay ! $decoder=scream
# shellcheck disable=SC2086
"${play[@]}" $encoder ! $send
wait "${children[-1]}"
same scream

has() { gst-inspect-1.0 "$1" >/dev/null 2>&1; }
# shellcheck disable=SC2086
if has mcapsink; then
  "${play[@]}" $encoder ! mcapsink location=drive.mcap
  "${play[@]}" mcapsrc location=drive.mcap ! $decoder=mcap
  cmp direct mcap
fi

server=$(PATH=$PATH:/usr/sbin:/usr/local/bin command -v nats-server || true)
# shellcheck disable=SC2086
if [ -n "$server" ] && has natssink; then
  start "grep -q 'Server is ready' output" "$server" -a 127.0.0.1 -p "${ports[1]}" -js -sd "$work/store"
  at="url=nats://127.0.0.1:${ports[1]} subject=robot jetstream=box"
  "${play[@]}" $encoder ! natssink $at drain-timeout=60000000000
  "${play[@]}" natssrc $at start-time=0 eos-at-end=true ! $decoder=nats
  cmp direct nats
fi

# The edge completes the file once the robot's goodbye has arrived.
closed() { [ "$(tail -c 8 "$1" 2>/dev/null | tr -d '\0' | tail -c +2 | head -c 5)" = MCAP0 ]; }
# shellcheck disable=SC2086
if [ -n "${LIDAR_EDGE:-}" ] && has mcapsink; then
  echo '{"http-port": 0, "robots": [{"name": "r1", "port": '"${ports[0]}"', "record": "'"$work"'/edge-%05d.mcap"}]}' >edge.json
  start bound "$LIDAR_EDGE" edge.json
  "${play[@]}" $encoder ! $send
  for _ in {1..600}; do
    if closed edge-00000.mcap; then break; fi
    sleep 0.1
  done
  closed edge-00000.mcap || { ls -l edge-* >&2; cat output >&2; exit 1; }
  "${play[@]}" mcapsrc location=edge-00000.mcap ! $decoder=edge
  same edge
fi
