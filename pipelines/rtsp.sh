#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# A LiDAR stream by RTSP on loopback: one server, and two viewers, over UDP and over the TCP connection of RTSP.
set -euo pipefail
source "$(dirname "$0")/options.sh"

usage() {
  cat <<'EOF2'
Usage: pipelines/rtsp.sh [CLOUDS]

Serves a synthetic sensor by RTSP on loopback, and views it with rtspsrc, over UDP and over TCP, until CLOUDS
slices (default 80) have been decoded each way.

The environment variable PORT is the TCP port of the server (default 0: any).
EOF2
}

only_count CLOUDS "$@"
source "$(dirname "$0")/environment.sh"
clouds=${1:-80}
server=$build/src/tools/lidar-rtsp-launch
[ -x "$server" ] || { echo "There is no $server: install libgstrtspserver-1.0-dev and build again." >&2; exit 1; }

folder=$(mktemp -d)
trap 'kill "${serving:-}" 2>/dev/null || true; wait 2>/dev/null || true; rm -rf "$folder"' EXIT

touch "$folder/address"
"$server" --port "${PORT:-0}" lidartestsrc is-live=true model=os0-32 mode=512x10 ! lidarenc max-error=0.05 ! \
  rtplidarpay name=pay0 >"$folder/address" &
serving=$!
until address=$(head -1 "$folder/address") && [ -n "$address" ]; do
  kill -0 $serving 2>/dev/null || { echo "FAILED: the server does not start" >&2; exit 1; }
  sleep 0.1
done

# view PROTOCOL: prints how many clouds arrived.
view() {
  timeout 600 gst-launch-1.0 -v rtspsrc location="$address" protocols="$1" latency=100 timeout=0 tcp-timeout=0 ! \
    rtplidardepay ! lidardec ! fakesink num-buffers="$clouds" sync=false silent=false >"$folder/$1" 2>&1 || true
  grep -c 'last-message = chain' "$folder/$1" || true
}
status=0
for protocol in udp tcp; do
  came=$(view $protocol)
  echo "$address over $protocol: $came clouds"
  [ "$came" -ge "$clouds" ] || { status=1; tail -5 "$folder/$protocol" >&2; }
done
[ $status = 0 ] || echo "FAILED: too few clouds came" >&2
exit $status
