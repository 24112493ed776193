#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Runs typical pipelines with GStreamer's leaks tracer. No object, buffer, event or caps may outlive
# its pipeline.
set -uo pipefail
passed=0
failed=0

# alive LOG: prints the lines of LOG about objects that were not freed.
alive() { grep -o 'object-alive, type-name=.*' <<<"$1" | grep -v '%s'; }

# run NAME PIPELINE...: runs the pipeline. Counts it as passed if it ends by itself and all objects
# are freed.
run() {
  local name=$1
  shift
  # A pipeline is skipped if one of its elements is not built.
  for word in "$@"; do
    case $word in
      dracoenc | dracodec | pointcloudview | ros2src | ros2sink)
        gst-inspect-1.0 "$word" >/dev/null 2>&1 || { echo "skipped $name: no $word"; return; } ;;
    esac
  done
  local log
  log=$(GST_TRACERS=leaks GST_DEBUG=GST_TRACER:7 GST_DEBUG_NO_COLOR=1 timeout 60 gst-launch-1.0 -q "$@" 2>&1)
  local status=$?
  if [ $status = 0 ] && ! alive "$log" | grep -q .; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "FAILED: $name (status $status)"
    { alive "$log"; grep -E "ERROR|CRITICAL" <<<"$log"; } | cut -c1-300 | head -10
  fi
}

source=(lidartestsrc model=os1-32 mode=512x10 num-buffers=24)
live=(lidartestsrc model=os1-32 mode=512x10 num-buffers=24 is-live=true)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

run assembler "${source[@]}" ! scanassembler ! fakesink
run "live assembler" "${live[@]}" ! scanassembler ! fakesink sync=true
run "PCD files" "${source[@]}" ! scanassembler ! pcdenc ! multifilesink "location=$folder/%d.pcd"
run "PLY files" "${source[@]}" ! scanassembler ! plyenc ! multifilesink "location=$folder/%d.ply"
run "raw files" "${source[@]}" slices-per-scan=1 ! multifilesink "location=$folder/%d.bin"
run parser multifilesrc "location=$folder/%d.bin" stop-index=2 \
  'caps=application/x-pointcloud2,height=32,point-step=20,fields=(string)"x:F32:0,y:F32:4,z:F32:8"' \
  ! pointcloudparse ! fakesink
run view "${source[@]}" ! pointcloudview width=320 height=180 ! fakesink
run "own codec" "${source[@]}" ! lidarenc ! lidardec ! scanassembler ! fakesink
run Draco "${source[@]}" ! dracoenc ! dracodec ! scanassembler ! fakesink
run RTP "${source[@]}" ! lidarenc ! rtplidarpay ! rtplidardepay ! lidardec ! scanassembler ! fakesink
run "ROS 2" "${live[@]}" ! ros2sink topic=/leaks_$$ async=false \
  ros2src topic=/leaks_$$ num-buffers=2 ! fakesink async=false
run SCReAM "${live[@]}" ! lidarenc ! rtplidarpay ! screamtx ! screamrx ! fakesink
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
