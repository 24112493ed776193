#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Draws the trajectories that the edge computed in experiments c and d, coloured by step and by
# error.
set -euo pipefail
. "$(dirname "$0")/common.sh" "$@"
. "$here/network.sh"

runs=1
streams <<TEXT
c
q16 $paper_codec --fixed-bits 16
TEXT
echo "name,x_m,y_m,step_m,error_m" >"$csv"
for name in c q16; do
  "$here/figures.py" way "$output/$name.1" | sed "s/^/$name,/" >>"$csv"
done
plot_height=620
plot <<TEXT
set multiplot layout 2,2; set size ratio -1; unset key
set palette defined (0 '#3a3e96', 0.5 '#38cca4', 1 '#e2463e'); set xlabel 'x [m]'; set ylabel 'y [m]'
do for [n in 'c q16'] {
  set title (n eq 'c' ? 'adaptive' : 'q = 16').': step [cm]'; set cbrange [0:10]
  plot '< grep ^'.n.', $csv' using 2:3:(\$4*100) with points pt 7 ps 0.4 palette
  set title (n eq 'c' ? 'adaptive' : 'q = 16').': error [m]'; set cbrange [0:*]
  plot '< grep ^'.n.', $csv' using 2:3:5 with points pt 7 ps 0.4 palette
}
TEXT
verdict "$(awk -F, 'NR > 1 { ++n[$1]; if ($5 > most[$1]) most[$1] = $5 } END {
  printf "poses at the edge: adaptive %d, off by %.2f m at most; q = 16 %d, %.2f m", n["c"], most["c"], n["q16"], most["q16"] }' "$csv")"
