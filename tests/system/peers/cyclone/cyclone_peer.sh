#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Tests ros2sink and ros2src with a program that uses Cyclone DDS, with type descriptions and
# without. Cyclone's own compiler generates the types of the program. The test is skipped if that
# compiler is missing.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../../.." && pwd)
. "$root/pipelines/environment.sh"
folder=$(mktemp -d)
running=()
stop() {
  local job
  for job in "${running[@]}"; do kill "$job" 2>/dev/null || true; wait "$job" 2>/dev/null || true; done
  running=()
}
trap 'stop; rm -rf "$folder"' EXIT

command -v idlc >/dev/null || { echo "there is no idlc"; exit 77; }
export CYCLONEDDS_URI='<General><Interfaces><NetworkInterface name="lo" multicast="true"/></Interfaces></General>'
# With such a domain the ports are below those that the kernel assigns by itself.
export ROS_DOMAIN_ID=$((10 + $$ % 90))

for types in described plain; do
  work=$folder/$types
  mkdir "$work"
  without=()
  [ $types = described ] || without=(-t)
  idlc "${without[@]}" -o "$work" "$here/ros.idl"
  "${CC:-cc}" -I"$work" "$here/peer.c" "$work/ros.c" -o "$work/peer" -lddsc

  gst-launch-1.0 -q lidartestsrc is-live=true model=os1-32 mode=512x10 slices-per-scan=1 \
    ! ros2sink topic=/to_peer frame-id=os_lidar >"$work/sink.log" 2>&1 &
  running+=($!)
  timeout 90 "$work/peer" sub rt/to_peer os_lidar || { echo "ros2sink to Cyclone, $types types"; cat "$work/sink.log"; exit 1; }
  stop

  "$work/peer" pub rt/from_peer os_lidar &
  running+=($!)
  timeout 90 gst-launch-1.0 -q ros2src topic=/from_peer qos=reliable num-buffers=3 ! filesink location="$work/taken" ||
    { echo "Cyclone to ros2src, $types types"; exit 1; }
  stop
  for _ in 1 2 3; do "$work/peer" data; done | cmp - "$work/taken"
  echo "$types types: three clouds each way"
done
