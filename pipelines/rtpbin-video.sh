#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# SCReAM in a classic rtpbin application: video both ways, RTCP SR/RR and our feedback side by side.
set -euo pipefail
source "$(dirname "$0")/options.sh"

usage() {
  cat <<'EOF'
Usage: pipelines/rtpbin-video.sh [options]

Two ends, each with an rtpbin, an H.264 camera and a decoder: A sends to B and B to A. screamtx sits behind rtpbin's
send_rtp_src, screamrx before its recv_rtp_sink; the feedback shares the RTCP port with rtpbin's reports.
Prints target and loss of both directions at the end, a line for each second.

  --duration S   how long [s] (default 15)
  --port P       first of four UDP ports to use (default 5304)
EOF
}

duration=15 port=5304
while [ $# -gt 0 ]; do
  case $1 in
    --duration) number "$@"; duration=$2; shift ;;
    --port) port "$@"; port=$2; shift ;;
    -h | --help) usage; exit 0 ;;
    *) wrong "there is no option $1" ;;
  esac
  shift
done
source "$(dirname "$0")/environment.sh"
need "" openh264enc openh264dec screamtx

work=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; wait 2>/dev/null || true; rm -rf "$work"' EXIT

# one_end NAME RTP_IN RTCP_IN RTP_OUT RTCP_OUT: runs one end of the call.
one_end() {
  local name=$1 rtp_in=$2 rtcp_in=$3 rtp_out=$4 rtcp_out=$5
  exec gst-launch-1.0 -m \
    rtpbin name=rtp latency=50 \
    videotestsrc is-live=true pattern=zone-plate kx2=30 ky2=20 kt=3 ! video/x-raw,width=640,height=480,framerate=30/1 ! \
    openh264enc complexity=low rate-control=bitrate gop-size=30 ! bitrateadapter min=200000 max=3000000 ! \
    h264parse ! rtph264pay pt=96 config-interval=-1 ! rtp.send_rtp_sink_0 \
    rtp.send_rtp_src_0 ! tx.sink_0 \
    screamtx name=tx max-bitrate=3500000 stats-interval=1000000000 ! \
    ecnudpsink host=127.0.0.1 port="$rtp_out" sync=false async=false \
    ecnudpsrc address=127.0.0.1 port="$rtcp_in" caps=application/x-rtcp ! tee name=rtcp \
    rtcp. ! tx.rtcp_sink rtcp. ! rtp.recv_rtcp_sink_0 \
    ecnudpsrc address=127.0.0.1 port="$rtp_in" \
    caps="application/x-rtp,media=video,clock-rate=90000,encoding-name=H264,payload=96" ! \
    screamrx name=rx ! rtp.recv_rtp_sink_0 \
    rtp. ! rtph264depay ! h264parse ! openh264dec ! progressreport update-freq=1 silent=true ! \
    fakesink sync=false async=false \
    funnel name=reports ! ecnudpsink host=127.0.0.1 port="$rtcp_out" sync=false async=false \
    rx.rtcp_src ! queue ! reports. \
    rtp.send_rtcp_src_0 ! queue ! reports. >"$work/$name" 2>&1
}

one_end A "$port" $((port + 1)) $((port + 2)) $((port + 3)) & a=$!
one_end B $((port + 2)) $((port + 3)) "$port" $((port + 1)) & b=$!
playing "$work/A" $a
playing "$work/B" $b
sleep "$duration"
decoded() { grep -q '"progress\|progress,' "$work/$1"; }
for ((i = 0; i < 600; ++i)); do
  ! { decoded A && decoded B; } && kill -0 $a $b 2>/dev/null || break
  sleep 0.1
done
kill -INT $a $b 2>/dev/null || true
until_ended $a $b

# report NAME: prints the target and the counters of one direction. Fails if hardly any feedback came.
report() {
  sed -n 's/^.*x-screamtx-stats, \(.*\)$/\1/p' "$work/$1" | awk -v name="$1" '
    function value(line, field) {
      if (!match(line, field "=\\([a-z0-9]*\\)[0-9]+")) return 0
      line = substr(line, RSTART, RLENGTH); sub(/.*\)/, "", line); return line
    }
    { printf "%s %3d s  target %5.2f  sent %5.2f Mbit/s  RTT %5.1f ms  lost %d  reports %d\n", name, NR - 1,
        value($0, "target-bitrate") / 1e6, value($0, "sent-bitrate") / 1e6, value($0, " rtt") / 1e6,
        value($0, "packets-lost"), value($0, "feedback-accepted")
      reports = value($0, "feedback-accepted") }
    END { exit reports > 10 ? 0 : 1 }'
}

failed=0
for name in A B; do
  report "$name" || { echo "No feedback reached $name." >&2; failed=1; }
  decoded "$name" || { echo "$name decoded nothing." >&2; failed=1; }
  grep -m5 -E 'ERROR|loop detected' "$work/$name" >&2 && failed=1
done
exit "$failed"
