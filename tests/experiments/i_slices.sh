#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Compares slices with whole scans: the age of the newest point at the edge, and the error of the
# current pose that follows from it.
set -euo pipefail
. "$(dirname "$0")/common.sh" "$@"
. "$here/network.sh"

runs=1
streams <<TEXT
c
whole --slices 1
TEXT
echo "name,point_age_p50_ms,point_age_p95_ms,pose_age_p50_ms,pose_age_p95_ms,held_p95_m,predicted_p95_m" >"$csv"
for pair in c:slices whole:whole; do
  "$here/figures.py" age "$output/${pair%%:*}.1" | sed "s/^/${pair##*:},/" >>"$csv"
done
plot <<TEXT
set style data histograms; set style fill solid; set ylabel 'age at the edge [ms]'; set yrange [0:*]
plot '$csv' using 2:xtic(1) title 'newest point, p50', '' using 3 title 'p95', '' using 4 title 'newest pose, p50', '' using 5 title 'p95'
TEXT
verdict "$(awk -F, 'NR > 1 { printf "%s%s: newest point %.0f ms old (p95 %.0f), pose of now off by %.2f m if held, %.3f m if predicted (p95)", (NR == 2 ? "" : "; "), $1, $2, $3, $6, $7 }' "$csv")"
