#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# LiDAR both ways between two webrtcbins, over a link of changing capacity, with TWCC as the feedback.
set -euo pipefail
source "$(dirname "$0")/options.sh"

usage() {
  cat <<'EOF'
Usage: pipelines/webrtc.sh [options]

Two LiDARs -> lidarenc -> rtplidarpay -> webrtcbin with screamaux, both in one process, which does the signalling.
What the caller sends passes lidar-link; what the callee sends has all the capacity that it needs. Prints both
directions twice a second. Exit code 0: scans came both ways, and the caller's bitrate followed the link; 3: scans and
reports came, but too few, or the bitrate did not follow, as on a busy machine; else 1.

  --high MBITS       capacity of the link in the first and third part [Mbit/s] (default 6)
  --low MBITS        capacity in the second part [Mbit/s] (default 2)
  --part S           how long each part lasts [s] (default 5)
  --rtt MS           round trip of the link [ms] (default 20)
  --port P           first of two UDP ports to use (default 5504)
EOF
}

high=6 low=2 part=5 rtt=20 port=5504
while [ $# -gt 0 ]; do
  case $1 in
    --high) number "$@"; high=$2; shift ;;
    --low) number "$@"; low=$2; shift ;;
    --part) number "$@"; part=$2; shift ;;
    --rtt) number "$@"; rtt=$2; shift ;;
    --port) port "$@"; port=$2; shift ;;
    -h | --help) usage; exit 0 ;;
    *) wrong "there is no option $1" ;;
  esac
  shift
done
source "$(dirname "$0")/environment.sh"
need "gstreamer1.0-plugins-bad and gstreamer1.0-nice" webrtcbin nicesink dtlssrtpenc screamaux

work=$(mktemp -d)
trap 'kill "${link:-}" 2>/dev/null || true; wait 2>/dev/null || true; rm -rf "$work"' EXIT

"$build/src/tools/lidar-link" --listen "127.0.0.1:$port" --forward "127.0.0.1:$((port + 1))" \
  --steps "$high,$low,$high" --step-time "$part" --once --rtt "$rtt" --queue 200 --aqm none --quiet &
link=$!

# This header extension makes webrtcbin number its packets. The reports of the other end use these
# numbers.
twcc=http://www.ietf.org/id/draft-holmer-rmcat-transport-wide-cc-extensions-01
caps="application/x-rtp,media=video,clock-rate=90000,encoding-name=X-LIDAR-DRACO,payload=96"
caps+=",extmap-1=(string)$twcc,rtcp-fb-transport-cc=(boolean)true"
"$build/src/tools/lidar-webrtc-launch" --aux "screamaux max-bitrate=20000000" \
  --stats caller-aux,callee-aux,there,back --interval 0.5 --duration "$(awk "BEGIN { print 3 * $part + 1 }")" \
  --port $((port + 1)) --relay "$port" \
  webrtcbin name=caller bundle-policy=max-bundle webrtcbin name=callee bundle-policy=max-bundle \
  lidartestsrc is-live=true model=os1-64 mode=1024x10 ! queue ! lidarenc max-error=0.1 ! rtplidarpay ! "$caps" ! caller. \
  lidartestsrc is-live=true model=os0-32 mode=512x10 ! queue ! lidarenc max-error=0.05 ! rtplidarpay ! "$caps" ! callee. \
  callee. ! rtplidardepay name=there ! lidardec ! fakesink sync=false async=false \
  caller. ! rtplidardepay name=back ! lidardec ! fakesink sync=false async=false >"$work/stats" ||
  { echo "FAILED: the call ended early." >&2; exit 1; }

# The steps of the link start with its first packet, at about the time when screamaux appears. The
# second part is judged by the mean of its second half, and the third part by its highest target.
awk -v high="$high" -v low="$low" -v part="$part" '
  function value(field) {
    if (!match($0, "[ ,]" field "=\\([a-z0-9]*\\)[0-9]+")) return 0
    text = substr($0, RSTART, RLENGTH); sub(/.*\)/, "", text); return text + 0
  }
  function fail(what, code) { print "FAILED: " what; if (failed != 1) failed = code }
  $2 == "caller-aux:" {
    target = value("target-bitrate") / 1e6; sent = value("sent-bitrate") / 1e6
    printf "%5.1f s  to the callee: target %5.2f  sent %5.2f Mbit/s  RTT %3.0f ms  reports %4d", $1, target, sent,
      value("rtt") / 1e6, value("twcc-reports")
    if (!start) start = $1 - 0.4
    at = $1 - start; p = int(at / part)
    if (at >= (p + 0.5) * part || p > 2) { p = p > 2 ? 2 : p; n[p]++; targets[p] += target; rates[p] += sent }
    if (at > 2 * part && target > highest) highest = target
  }
  $2 == "callee-aux:" {
    reports = value("twcc-reports")
    printf "   to the caller: target %5.2f Mbit/s  reports %4d\n", value("target-bitrate") / 1e6, reports
  }
  $2 == "there:" { there = value("scans-complete") }
  $2 == "back:" { back = value("scans-complete") }
  END {
    if (!n[0] || !n[1] || !n[2]) { fail("the call was too short", 1); exit 1 }
    for (p = 0; p < 3; ++p) { targets[p] /= n[p]; rates[p] /= n[p] }
    printf "%g, %g, %g Mbit/s: mean target %.2f, %.2f, %.2f; %d scans came there, %d back\n", high, low, high,
      targets[0], targets[1], targets[2], there, back
    possible = 10 * (3 * part - 2)
    if (there < 0.5 * possible) fail("too few scans reached the callee", there ? 3 : 1)
    if (back < 0.8 * possible) fail("too few scans reached the caller", back ? 3 : 1)
    if (reports < 10) fail("the callee got no reports", reports ? 3 : 1)
    if (rates[1] > 1.1 * low || targets[1] < 0.3 * low) fail("the bitrate did not follow the link down", 3)
    if (highest < 1.25 * low) fail("the target did not follow the link up", 3)
    if (!failed) print "OK: the bitrate followed the link by TWCC"
    exit failed
  }' "$work/stats"
