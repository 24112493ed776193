#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Measures the drive of experiment c without adaptation: with Draco at q = 16 as in the paper, and
# with lidarenc at a fixed step. In a third run Draco adapts. This run separates the effect of the
# codec from the effect of adaptation.
set -euo pipefail
. "$(dirname "$0")/common.sh" "$@"
. "$here/network.sh"

streams <<TEXT
c
q16 $paper_codec --fixed-bits 16
step2cm --fixed-step 0.02
draco $paper_codec
TEXT
names=(c q16 step2cm draco)
{ echo "$row_header"; rows "${names[@]}"; } >"$csv"
plot <<TEXT
names = 'c q16 step2cm draco'
set multiplot layout 1,2; set xrange [-0.6:3.6]; set yrange [0:*]; unset key
set xtics ('adaptive' 0, 'q = 16' 1, 'step 2 cm' 2, 'Draco, adapts' 3)
place(name) = name eq 'c' ? 0 : name eq 'q16' ? 1 : name eq 'step2cm' ? 2 : 3
set title 'part of the scans that did not arrive whole'
plot '$csv' skip 1 using (place(strcol(1))):(1-\$4/\$3) with points pt 7 ps 1.5
set title 'error of the poses [m]'; set key top left inside; set logscale y; set yrange [*:*]
plot '$csv' skip 1 using (place(strcol(1))-0.1):12 with points pt 7 ps 1.5 title 'ATE', '' skip 1 using (place(strcol(1))+0.1):14 with points pt 6 ps 1.5 title 'now, RMSE'
TEXT
of() { echo "$(middle complete "$csv" "$1") scans whole, $(middle pauses "$csv" "$1") pauses of half a second, ATE $(middle ate_m "$csv" "$1") m, of the pose of now $(middle now_rmse_m "$csv" "$1") m, p95 capture to cloud $(middle cloud_p95_ms "$csv" "$1") ms"; }
verdict "of $(middle scans "$csv" c): adaptive $(of c); Draco at q = 16 $(of q16); step 2 cm $(of step2cm); adaptive Draco $(of draco)"
