#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# The same drive without adaptation: q = 16 as in the paper, and a fixed step.
set -euo pipefail
. "$(dirname "$0")/common.sh" "$@"
. "$here/network.sh"

echo "$row_header" >"$csv"
for run in $(seq $runs); do
  stream c "$run"
  stream q16 "$run" --fixed-bits 16
  stream step2cm "$run" --fixed-step 0.02
  for name in c q16 step2cm; do row $name "$run"; done >>"$csv"
done
plot <<TEXT
set ylabel 'part of the scans that arrived whole'; set yrange [0:1.05]; set xrange [-0.5:2.5]; set boxwidth 0.6; set style fill solid
set xtics ('adaptive' 0, 'q = 16' 1, 'step 2 cm' 2)
plot '$csv' skip 1 using (strcol(1) eq 'c' ? 0 : strcol(1) eq 'q16' ? 1 : 2):(\$4/\$3) with boxes notitle
TEXT
of() { echo "$(middle complete "$csv" "$1") scans whole, ATE $(middle ate_m "$csv" "$1") m, p95 capture to cloud $(middle cloud_p95_ms "$csv" "$1") ms"; }
verdict "of $(middle scans "$csv" c): adaptive $(of c); q = 16 $(of q16); step 2 cm $(of step2cm)"
