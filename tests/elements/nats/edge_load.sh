#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Measures what each robot costs lidar-edge, with JetStream: the processor time per slice, and the
# memory. The slices of one sensor are sent as if they were those of many robots, each with its own
# SCReAM. This script is run by hand (docs/results/fleet.md).
# usage: edge_load.sh ROBOTS SECONDS [FIRST_PORT]
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
. "$here/../../../pipelines/environment.sh"
[ $# -ge 2 ] || { echo "usage: edge_load.sh ROBOTS SECONDS [FIRST_PORT]" >&2; exit 2; }
robots=$1 seconds=$2 first=${3:-25100}
PATH=$PATH:/usr/sbin
folder=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; wait 2>/dev/null || true; rm -rf "$folder"' EXIT

nats-server -a 127.0.0.1 -p -1 -js -sd "$folder/store" --ports_file_dir "$folder" -l "$folder/log" &
until url=$(grep -oh 'nats://127[^"]*' "$folder"/*.ports 2>/dev/null); do sleep 0.1; done

list=() branches=()
for ((i = 0; i < robots; i++)); do
  list+=("{\"name\": \"r$i\", \"port\": $((first + i))}")
  branches+=(t. ! queue ! rtplidarpay ! screamsink host=127.0.0.1 port=$((first + i)))
done
printf '{"http-port": 0, "interval": 0.5, "nats": {"url": "%s", "jetstream": "fleet"}, "robots": [%s]}' \
  "$url" "$(IFS=,; echo "${list[*]}")" >"$folder/edge.json"
"$build/src/tools/apps/edge/lidar-edge" "$folder/edge.json" >"$folder/out" 2>"$folder/err" &
until metrics=$(sed -n "s/^metrics //p" "$folder/out" 2>/dev/null) && [ -n "$metrics" ]; do sleep 0.1; done

# Prints the sum of metric $1 over all robots.
metric() { curl -s "$metrics" | awk -v name="$1" '$1 ~ "^" name "({|$)" { s += $2 } END { print s + 0 }'; }
sleep 2
idle=$(metric process_resident_memory_bytes)
gst-launch-1.0 -q lidartestsrc is-live=true model=os1-64 mode=1024x10 ! lidarenc ! tee name=t "${branches[@]}" \
  >"$folder/robots" 2>&1 &
until [ "$(metric lidar_edge_receiving)" = "$robots" ]; do sleep 0.5; done
sleep 2
sample() {
  echo "$(metric process_cpu_seconds_total) $(metric lidar_rtplidardepay_slices_received) $(metric lidar_natssink_bytes)"
}
read -r cpu slices bytes <<<"$(sample)"
sleep "$seconds"
read -r cpu2 slices2 bytes2 <<<"$(sample)"
awk -v cpu="$cpu" -v cpu2="$cpu2" -v slices="$slices" -v slices2="$slices2" -v bytes="$bytes" -v bytes2="$bytes2" \
  -v idle="$idle" -v busy="$(metric process_resident_memory_bytes)" -v robots="$robots" -v seconds="$seconds" 'BEGIN {
  n = slices2 - slices; rate = n / seconds / robots; core = (cpu2 - cpu) / seconds / robots
  printf "%d robots, each %.0f slices/s of %.0f bytes, %.1f Mbit/s\n", robots, rate, (bytes2 - bytes) / n,
    (bytes2 - bytes) * 8e-6 / seconds / robots
  printf "%.1f %% of a core for each robot, %.0f us for each slice: %.0f robots a core\n",
    core * 100, core / rate * 1e6, 1 / core
  printf "memory %.1f MB listening, %.1f MB receiving\n", idle / 1e6, busy / 1e6
}'
echo "dropped $(metric lidar_natssink_messages_dropped), lost $(metric lidar_rtplidardepay_slices_lost)," \
  "acknowledged $(metric lidar_natssink_messages_acknowledged)"
