#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Measures how the trajectory error of SLAM depends on the compression: on q for the paper's codec,
# and on the step for ranges.
set -euo pipefail
. "$(dirname "$0")/common.sh" "$@"

steps="0.01 0.02 0.04 0.1 0.2 0.5 1 2"
bits="8 10 12 14 16 24"
[ $quick = no ] || { steps="0.04 0.1 0.2 0.5"; bits="8 10 12 16"; }

echo "source,grid,setting,ate_m,ate_to_uncompressed_m,drift,degenerate" >"$csv"
sources=(synth:os0-32:street synth:os0-32:field synth:os0-32:tunnel)
[ -z "$capture" ] || sources+=("$capture")
number() { jq -r "$1 // \"\"" <<<"$2"; }
measure() { # SOURCE GRID SETTING [options]
  local source=$1 grid=$2 setting=$3 name whole one other=''
  shift 3
  name=$(basename "${source##*:}" .pcap)
  whole=$output/b.$name.tum
  # Writes the trajectory of the uncompressed scans to $whole. The other trajectories are compared
  # with it, because the true trajectory of a capture is unknown.
  if [ "$grid" = none ]; then
    one=$(slam "$source" --scans $offline_scans --out "$whole")
  else
    one=$(slam "$source" --scans $offline_scans --out "$output/b.tum" "$@")
    other=$("$tools/lidar-eval" ate --json "$whole" "$output/b.tum" | jq -r .ate_rmse_m)
  fi
  echo "$name,$grid,$setting,$(number .error.ate_rmse_m "$one"),$other,$(number .error.drift "$one"),$(jq -r '.degenerate / .scans' <<<"$one")"
}
for source in "${sources[@]}"; do
  # The tunnel is measured without compression only. SLAM cannot see the motion there, so the errors
  # do not come from compression.
  measure "$source" none 0
  [[ $source != *:tunnel ]] || continue
  for step in $steps; do measure "$source" range "$step" --step "$step"; done
  for q in $bits; do measure "$source" cube "$q" --xyz-bits "$q"; done
done >>"$csv"

plot <<TEXT
set multiplot layout 1,2
set logscale y; set ylabel 'ATE [m]'; set key top left inside
set logscale x; set xlabel 'step of the ranges [m]'
plot for [s in 'street field'] '< grep ^'.s.',range $csv' using 3:4 with linespoints pt 7 title s, \
  for [s in 'street field'] '< grep ^'.s.',none $csv' using (0.005):4 with points pt 6 ps 2 title s.', uncompressed'
unset logscale x; set xlabel 'q [bits over the cube]'; set key top right inside
plot for [s in 'street field'] '< grep ^'.s.',cube $csv' using 3:4 with linespoints pt 7 title s
TEXT
verdict "$(awk -F, '
  $1 == "street" && $2 == "none" { plain = $4; drift = $6 }
  $1 == "field" && $2 == "none" { field = $6 }
  $1 == "tunnel" && $2 == "none" { blind = $7 }
  $1 == "street" && $2 == "range" && $3 == 0.04 { fine = $4 }
  $1 == "street" && $2 == "range" && !knee && $4 > 2 * plain + 0.02 { knee = $3 }
  $1 == "street" && $2 == "cube" && $4 <= 2 * plain + 0.02 && (!q || $3 < q) { q = $3 }
  END {
    within = fine - plain <= 0.02 || fine <= 1.05 * plain
    printf "max-error 2 cm in the street: ATE %.3f m, uncompressed %.3f m (%s); knee at a step of %s m, q >= %s; drift %.2f %% street, %.2f %% field (goal 0.8); the tunnel hides the motion in %.0f %% of its scans, and it is said",
      fine, plain, within ? "within 5 % or 2 cm" : "MORE than 5 % and 2 cm", knee ? knee : "none seen", q ? q : "none seen", 100 * drift, 100 * field, 100 * blind }' "$csv")"
