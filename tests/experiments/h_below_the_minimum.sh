#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Measures the trajectory error for each degradation-preference at target bitrates above and below
# r_min. This is the least bitrate that keeps the bound of the error.
set -euo pipefail
. "$(dirname "$0")/common.sh" "$@"

source="lidartestsrc model=os0-32 scene=street speed=$speed seed=$seed num-buffers=$((8 * offline_scans)) trajectory-location=$output/h.truth.tum"
# The effort is fixed, because the automatic effort depends on how busy the machine is.
encoder="lidarenc max-error=0.05 intensity-bits=0 effort=2"
# Measures r_min, the bitrate when all slices are encoded with the coarsest step that keeps the
# bound.
# shellcheck disable=SC2086
gst-launch-1.0 -q ${source/num-buffers=$((8 * offline_scans))/num-buffers=400} ! $encoder ! filesink location="$output/h.bin"
minimum=$(($(stat -c %s "$output/h.bin") * 8 / 5))
rm -f "$output/h.bin"
echo "preference,share,bitrate,poses,ate_m" >"$csv"
for share in 1.2 0.75 0.5 0.25; do
  for preference in maintain-accuracy maintain-framerate balanced; do
    bitrate=$(awk "BEGIN { printf \"%d\", $minimum * $share }")
    # shellcheck disable=SC2086
    gst-launch-1.0 -q $source ! $encoder bitrate="$bitrate" degradation-preference=$preference ! lidardec ! scanassembler \
      ! lidarodometry post-messages=false trajectory="$output/h.edge.tum" ! fakesink >"$output/h.log" 2>&1
    "$tools/lidar-eval" ate --json "$output/h.truth.tum" "$output/h.edge.tum" |
      jq -r --arg p $preference --arg s $share --arg b "$bitrate" '[$p, $s, $b, .poses, .ate_rmse_m] | join(",")'
  done
done >>"$csv"
plot <<TEXT
set xlabel 'target, as part of r_min'; set ylabel 'ATE [m]'; set logscale y
plot for [p in 'maintain-accuracy maintain-framerate balanced'] '< grep ^'.p.', $csv' using 2:5 with linespoints pt 7 title p
TEXT
verdict "$(awk -F, -v all=$offline_scans -v min="$minimum" 'NR > 1 && $2 == 0.5 { text = text sprintf("%s%s %.3f m with %d of %d poses", text ? "; " : "", $1, $5, $4, all) }
  END { printf "r_min %.2f Mbit/s; ATE at half of it: %s", min / 1e6, text }' "$csv")"
