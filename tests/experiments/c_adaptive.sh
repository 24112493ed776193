#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# A drive over a mobile network with L4S, adaptive: what the paper's system does.
set -euo pipefail
. "$(dirname "$0")/common.sh" "$@"
. "$here/network.sh"

echo "$row_header" >"$csv"
for run in $(seq $runs); do
  stream c "$run"
  row c "$run" >>"$csv"
done
plot_height=1300
plot <<TEXT
f = '$output/c.1/timeline.csv'
set multiplot layout 5,1; set xlabel ''; set key outside right top
set ylabel 'kB'; plot f skip 1 using 1:(\$8/1000) with lines title 'ref\\_wnd', '' skip 1 using 1:(\$9/1000) with lines title 'in flight'
set ylabel 'ms'; plot f skip 1 using 1:7 with lines title 'RTT', '' skip 1 using 1:6 with lines title 'queue', '' skip 1 using 1:10 with lines title 'sender queue'
set ylabel 'Mbit/s'; plot f skip 1 using 1:2 with steps lc rgb '#999999' title 'capacity', '' skip 1 using 1:3 with lines title 'target', '' skip 1 using 1:4 with lines title 'encoded', '' skip 1 using 1:5 with lines title 'sent', '' skip 1 using 1:(\$2 < 0.25 ? 0 : NaN) with points pt 7 lc rgb 'red' title 'gap'
set ylabel 'cm'; plot f skip 1 using 1:(\$11*100) with steps title 'step'
set xlabel 'time [s]'; plot f skip 1 using 1:(\$12 > 0 ? \$12*100 : NaN) with points pt 7 ps 0.3 title 'largest error', 5 dt 2 title 'bound'
TEXT
verdict "largest error $(middle max_error_m "$csv" c) m of 0.05; whole scans $(middle complete "$csv" c) of $(middle scans "$csv" c), the oracle $(middle oracle "$csv" c); p95 capture to cloud $(middle cloud_p95_ms "$csv" c) ms, to pose $(middle pose_p95_ms "$csv" c) ms; ATE $(middle ate_m "$csv" c) m, uncompressed $(middle ate_uncompressed_m "$csv" c) m"
