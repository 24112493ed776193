#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# A LiDAR and a camera share one congestion-controlled path, over an L4S bottleneck on loopback.
set -euo pipefail
source "$(dirname "$0")/options.sh"

usage() {
  cat <<'EOF'
Usage: pipelines/lidar-and-video.sh [options]

Synthetic LiDAR (lidarenc) and camera (openh264enc, through bitrateadapter) -> screamsink -> lidar-link ->
screamsrc -> both depayloaded. One controller, shares by priority. Prints the bitrates each second.

  --rate MBITS       capacity of the link [Mbit/s] (default 8)
  --trace FILE       capacity from lines of 'time_s rate_mbps', as lidar-trace prints them, in place of --rate
  --rtt MS           round trip of the link [ms] (default 40)
  --lidar-share N    priority of the LiDAR; the camera has 1 (default 2)
  --duration S       how long [s] (default 20)
  --port P           first of two UDP ports to use (default 5204)
EOF
}

rate=8 trace= rtt=40 share=2 duration=20 port=5204
while [ $# -gt 0 ]; do
  case $1 in
    --rate) number "$@"; rate=$2; shift ;;
    --trace) file "$@"; trace=$2; shift ;;
    --rtt) number "$@"; rtt=$2; shift ;;
    --lidar-share) number "$@"; share=$2; shift ;;
    --duration) number "$@"; duration=$2; shift ;;
    --port) port "$@"; port=$2; shift ;;
    -h | --help) usage; exit 0 ;;
    *) wrong "there is no option $1" ;;
  esac
  shift
done
source "$(dirname "$0")/environment.sh"
need "" openh264enc lidarenc screamsink

work=$(mktemp -d)
trap 'kill "${link:-}" "${receiver:-}" "${sender:-}" 2>/dev/null || true; wait 2>/dev/null || true; rm -rf "$work"' EXIT

capacity=(--rate "$rate")
[ -z "$trace" ] || capacity=(--trace "$trace")
"$build/src/tools/lidar-link" --listen "127.0.0.1:$port" --forward "127.0.0.1:$((port + 1))" \
  "${capacity[@]}" --rtt "$rtt" --aqm ramp --quiet &
link=$!

lidar_caps='application/x-rtp,media=application,clock-rate=90000,encoding-name=X-LIDAR-DRACO'
video_caps='application/x-rtp,media=video,clock-rate=90000,encoding-name=H264'
gst-launch-1.0 -v \
  screamsrc name=in address=127.0.0.1 port=$((port + 1)) \
  pt-map="application/x-rtp-pt-map,96=(string)\"$lidar_caps\",97=(string)\"$video_caps\"" \
  in. ! application/x-rtp,media=application ! rtplidardepay ! lidardec ! scanassembler ! \
  identity name=scans drop-buffer-flags=corrupted silent=false ! fakesink sync=false async=false \
  in. ! application/x-rtp,media=video ! rtph264depay ! h264parse ! \
  filesink location="$work/video.h264" sync=false async=false >"$work/receiver.log" &
receiver=$!
listening "$port" "$link" && listening $((port + 1)) "$receiver" ||
  { echo "The link or the receiver did not start." >&2; exit 1; }

# Prints one line for each of the sender's statistics. The quotes within the array of streams are
# escaped, so the backslashes are removed first.
show() {
  sed -nu 's/\\//g; s/^.*x-screamtx-stats, \(.*\)$/\1/p' | awk '
    function value(line, name) {
      if (!match(line, name "=\\([a-z0-9]*\\)[0-9]+")) return 0
      line = substr(line, RSTART, RLENGTH); sub(/.*\)/, "", line); return line
    }
    { n = split($0, stream, "stream, pad")
      printf "%3d s  target %6.2f  sent %6.2f Mbit/s  queue delay %5.1f ms", NR - 1,
        value($0, "target-bitrate") / 1e6, value($0, "sent-bitrate") / 1e6, value($0, "queue-delay") / 1e6
      for (i = 2; i <= n; ++i)
        printf "  %s %6.2f", i == 2 ? "LiDAR" : "camera", value(stream[i], "sent-bitrate") / 1e6
      printf "\n"; fflush() }'
}

gst-launch-1.0 -e -m \
  screamsink name=out host=127.0.0.1 port="$port" stats-interval=1000000000 sink_0::priority="$share" \
  lidartestsrc is-live=true model=os1-64 mode=1024x10 ! queue ! lidarenc max-error=0.05 ! \
  rtplidarpay pt=96 ! out.sink_0 \
  videotestsrc is-live=true pattern=zone-plate kx2=30 ky2=20 kt=3 ! video/x-raw,width=640,height=480,framerate=30/1 ! \
  queue ! openh264enc complexity=low rate-control=bitrate gop-size=300 ! bitrateadapter min=300000 max=4000000 ! \
  h264parse ! rtph264pay pt=97 config-interval=-1 ! out.sink_1 \
  >"$work/sender" 2>"$work/sender.err" &
sender=$!
tail -f --pid=$sender "$work/sender" | show &
shown=$!
playing "$work/sender" $sender
sleep "$duration"
kill -INT $sender 2>/dev/null || true
until_ended $sender
wait $shown || true
[ ! -s "$work/sender.err" ] || grep -E 'ERROR|WARN' "$work/sender.err" >&2 || true

# The sender's goodbye ends the receiver. If the sender could not start, there is no goodbye, so the
# receiver is killed.
[ -s "$work/sender" ] || kill "$receiver" 2>/dev/null || true
until_ended "$receiver"
scans=$(grep -c 'chain.*scans' "$work/receiver.log" || true)
[ "$scans" -gt 0 ] || { echo "No whole scan arrived." >&2; exit 1; }
[ -s "$work/video.h264" ] || { echo "No video arrived." >&2; exit 1; }
echo "received: $scans whole scans in $duration s, $(stat -c %s "$work/video.h264") bytes of video"
