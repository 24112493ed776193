#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Tests that MCAP's own library for JavaScript can read recordings of mcapsink. The test is skipped
# if npm cannot install the library.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../../.." && pwd)
. "$root/pipelines/environment.sh"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

command -v npm >/dev/null || { echo "there is no npm"; exit 77; }
cp "$here/package.json" "$here/package-lock.json" "$here/check.mjs" "$folder"
(cd "$folder" && npm ci --silent --no-audit --no-fund) || { echo "npm cannot install"; exit 77; }

sensor="lidartestsrc model=os1-32 mode=512x10 speed=5 num-buffers"
for compression in none lz4 zstd; do
  file=$folder/$compression.mcap
  # shellcheck disable=SC2086
  gst-launch-1.0 -q -e mcapsink name=m location="$file" compression=$compression chunk-duration=300000000 \
    $sensor=10 slices-per-scan=1 ! lidarodometry name=o o.src ! tee name=t \
    t. ! queue ! m. t. ! queue ! lidarenc ! m. o.odometry ! queue ! m. \
    $sensor=40 ! lidarenc ! queue ! m.sink_9
  node "$folder/check.mjs" "$file" /points=10 /odometry=10
done
gst-launch-1.0 -q -e ouster_src location="$root/tests/data/ouster/OS-1-128_v2.3.0_1024x10_lb_n3.pcap" \
  metadata="$root/tests/data/ouster/OS-1-128_v2.3.0_1024x10.json" name=s ! queue ! lidarenc ! mcapsink name=m \
  location="$folder/imu.mcap" s.imu ! queue ! m.
node "$folder/check.mjs" "$folder/imu.mcap"
