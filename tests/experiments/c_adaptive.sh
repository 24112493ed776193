#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Measures a drive over a mobile network with L4S whose encoder adapts to the network, as in the
# paper's system.
set -euo pipefail
. "$(dirname "$0")/common.sh" "$@"
. "$here/network.sh"

# Runs the drive over the first --trace, and again over each further --trace.
names=(c)
for trace in "${traces[@]:1}"; do names+=("c@$(basename "$trace" .txt)"); done
printf '%s\n' "${names[@]}" | streams
{ echo "$row_header"; rows "${names[@]}"; } >"$csv"
plot_width=1400 plot_height=1300
plot <<TEXT
f = '$output/c.1/timeline.csv'
set multiplot layout 5,1; set key outside right top; set lmargin 9; set rmargin 20; set xrange [0:$seconds]
set ylabel 'kB'; plot f skip 1 using 1:(\$8/1000) with lines title 'ref\\_wnd', '' skip 1 using 1:(\$9/1000) with lines title 'in flight'
set ylabel 'ms'; plot f skip 1 using 1:7 with lines title 'RTT', '' skip 1 using 1:6 with lines title 'queue', '' skip 1 using 1:10 with lines title 'sender queue'
set logscale y; set yrange [0.1:*]
set ylabel 'Mbit/s'; plot f skip 1 using 1:2 with steps lc rgb '#bbbbbb' title 'capacity', '' skip 1 using 1:3 with lines title 'target', '' skip 1 using 1:4 with lines title 'encoded', '' skip 1 using 1:5 with lines title 'sent', '' skip 1 using 1:(\$2 < 0.25 ? 0.12 : NaN) with points pt 7 ps 0.5 lc rgb 'red' title 'gap'
unset logscale y; set yrange [0:*]
set ylabel 'cm'; plot f skip 1 using 1:(\$11*100) with steps title 'step'
set xlabel 'time [s]'; plot f skip 1 using 1:(\$12 > 0 ? \$12*100 : NaN) with points pt 7 ps 0.3 title 'largest error', 5 dt 2 title 'bound'
TEXT
of() { echo "largest error $(middle max_error_m "$csv" "$1") m of 0.05; whole scans $(middle complete "$csv" "$1") of $(middle scans "$csv" "$1"), the oracle $(middle oracle "$csv" "$1"); p95 capture to cloud $(middle cloud_p95_ms "$csv" "$1") ms, to pose $(middle pose_p95_ms "$csv" "$1") ms; ATE $(middle ate_m "$csv" "$1") m, uncompressed $(middle ate_uncompressed_m "$csv" "$1") m, of the pose of now $(middle now_rmse_m "$csv" "$1") m"; }
text=$(of c)
for name in "${names[@]:1}"; do text+="; over ${name#c@}: $(of "$name")"; done
verdict "$text"
