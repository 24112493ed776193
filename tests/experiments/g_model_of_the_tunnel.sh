#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Compares encoded sizes with their targets in the street, for a size model that was trained in the
# tunnel.
set -euo pipefail
. "$(dirname "$0")/common.sh" "$@"

model=$output/g.model.json
"$tools/lidar-train" synth:os0-32:tunnel --modes range-adaptive --intensity-bits 0 --slices 8 --speed $speed -o "$model" >"$output/g.train.log" 2>&1
echo "model,scan,target_bps,sent_bps" >"$csv"
track() { # NAME [options]
  local name=$1
  shift
  "$tools/lidar-eval" track synth:os0-32:street --profiles jump --length 100 --scans 40 --speed $speed --max-error 0.05 \
    --csv "$output/g.$name.csv" "$@" >"$output/g.$name.log" 2>&1
  awk -F, -v name="$name" 'NR > 1 { print name "," $1 "," $2 "," $3 }' "$output/g.$name.csv"
}
{ track tunnel --model "$model"; track built-in; track paper --model "$model" --rate-model paper --open-loop; } >>"$csv"
plot <<TEXT
set xlabel 'scan'; set ylabel 'Mbit/s'
plot '< grep ^tunnel, $csv' using 2:(\$3/1e6) with steps lc rgb '#999999' title 'target', \
  for [m in 'tunnel built-in paper'] '< grep ^'.m.', $csv' using 2:(\$4/1e6) with lines title m
TEXT
verdict "$(awk -F, 'NR > 1 && $2 >= 2 && $3 > 0 { e = ($4 - $3) / $3; sum[$1] += e < 0 ? -e : e; ++n[$1]; if (e > over[$1]) over[$1] = e }
  END { for (m in n) text = text sprintf("%s%s %.1f %% (furthest over %.1f %%)", text ? "; " : "", m, 100 * sum[m] / n[m], 100 * over[m])
        print "encoded is off the target, mean: " text }' "$csv")"
