#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Measures how far points are moved by the grid of the paper, which has q bits over the cube, and by
# the grid of ranges.
set -euo pipefail
. "$(dirname "$0")/common.sh" "$@"

echo "grid,setting,mean_m,max_m" >"$csv"
measure() { # GRID SETTING OPTION
  slam synth:os0-32:street --scans 10 "$3" "$2" |
    jq -r --arg grid "$1" --arg setting "$2" '[$grid, $setting, .mean_point_error_m, .max_point_error_m] | join(",")'
}
for bits in $(seq 8 24); do measure cube "$bits" --xyz-bits; done >>"$csv"
for step in 0.002 0.005 0.01 0.02 0.04 0.07 0.1 0.2 0.5; do measure range "$step" --step; done >>"$csv"

plot <<TEXT
set multiplot layout 1,2
set logscale y; set ylabel 'point error [m]'; set key top right inside
set xlabel 'q [bits over the cube]'
plot '< grep ^cube $csv' using 2:4 with linespoints pt 7 title 'largest', '' using 2:3 with linespoints pt 6 title 'mean', 0.05 dt 2 title '5 cm'
set logscale x; set xlabel 'step of the ranges [m]'; set key top left inside
plot '< grep ^range $csv' using 2:4 with linespoints pt 7 title 'largest', '' using 2:3 with linespoints pt 6 title 'mean', 0.05 dt 2 title '5 cm'
TEXT
verdict "$(awk -F, '
  $1 == "cube" && $4 <= 0.05 && !q { q = $2; e = $4 }
  $1 == "range" && $4 <= 0.0501 { step = $2; mean = $3 }
  END { printf "5 cm for every point takes q = %d (%.1f cm at most), or a step of %g m (mean %.1f cm)", q, 100 * e, step, 100 * mean }' "$csv")"
