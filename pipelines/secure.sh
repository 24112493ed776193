#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# A LiDAR stream over SRTP on loopback: both ends, the key in the environment, feedback protected too.
set -euo pipefail
source "$(dirname "$0")/options.sh"

usage() {
  cat <<'EOF'
Usage: pipelines/secure.sh [SECONDS]

A LiDAR stream over SRTP on loopback: both ends share a key, and feedback is protected, too.

  SECONDS   how long it sends (default 5)

The environment variable PORT is the first of the UDP ports to use (default 5044).
EOF
}

only_count SECONDS "$@"
source "$(dirname "$0")/environment.sh"
seconds=${1:-5}
port=${PORT:-5044}

need gstreamer1.0-plugins-bad srtpenc

# The key has 16 bytes and the salt has 14. They are in the environment, so that the list of
# processes does not show them.
LIDAR_SRTP_KEY=$(od -An -tx1 -N30 /dev/urandom | tr -d ' \n')
export LIDAR_SRTP_KEY

log=$(mktemp)
trap 'kill "${receiver:-}" 2>/dev/null || true; rm -f "$log"' EXIT
gst-launch-1.0 screamsrc port="$port" srtp-key=env:LIDAR_SRTP_KEY ! rtplidardepay ! lidardec ! \
  identity silent=false ! fakesink sync=false -v >"$log" 2>&1 &
receiver=$!
listening "$port" $receiver || { cat "$log" >&2; echo "FAILED: the receiver did not start" >&2; exit 1; }
(launch lidartestsrc is-live=true num-buffers=$((seconds * 80)) ! lidarenc max-error=0.05 ! rtplidarpay ! \
  screamsink host=127.0.0.1 port="$port" srtp-key=env:LIDAR_SRTP_KEY)
until_ended $receiver  # ended by the sender's goodbye
clouds=$(grep -c 'chain.*identity' "$log" || true)
echo "sent $((seconds * 80)) slices over SRTP, $clouds came out"
[ "$clouds" -gt 0 ] || { echo "FAILED: no cloud came out" >&2; exit 1; }
