# SPDX-License-Identifier: LGPL-2.1-or-later
# Sourced by the experiments over a network: sender, link and receiver in real time, with SLAM.

# stream NAME RUN [options of the demo]: the report is in $output/NAME.RUN. Broken guarantees and
# poor streams are results, not failures.
stream() {
  local name=$1 run=$2 folder=$output/$1.$2 path
  shift 2
  path=(--drive --rate "$rate")
  [ -z "$trace" ] || path=(--trace "$trace")
  [ -f "$folder/summary.json" ] && [ "$folder/summary.json" -nt "$output/started" ] && return
  "$tools/lidar-demo" run --slam --no-plots --duration $seconds --model os0-32 --scene town \
    --speed $speed --seed $((seed + run - 1)) --max-error 0.05 --output "$folder" "${path[@]}" \
    "$@" >"$folder.log" 2>&1 || [ -f "$folder/summary.json" ] ||
    { tail -5 "$folder.log" >&2; return 1; }
}
[ -f "$output/started" ] || touch "$output/started"

# uncompressed RUN: the ATE of the same drive without codec and network.
uncompressed() {
  local file=$output/uncompressed.$1.json
  [ -f "$file" ] && [ "$file" -nt "$output/started" ] ||
    "$tools/lidar-eval" slam synth:os0-32:town --json --speed $speed --scans $scans \
      --seed $((seed + $1 - 1)) >"$file" 2>/dev/null
  jq -r .error.ate_rmse_m "$file"
}

# row NAME RUN: one line of the table of runs.
row_header="name,run,scans,complete,oracle,skipped,slices_lost,rate_mbps,max_error_m,cloud_p95_ms,pose_p95_ms,ate_m,ate_uncompressed_m"
row() {
  jq -r --arg name "$1" --arg run "$2" --arg plain "$(uncompressed "$2")" '[$name, $run, .scans_captured,
    .scans_complete, (.oracle.scans_complete // ""), .scans_skipped, .slices_lost, (.mean_rate_bps / 1e6),
    .max_error_m, .capture_to_cloud_ms.p95, .slam.capture_to_pose_ms.p95, (.slam.ate_rmse_m // ""),
    $plain] | join(",")' "$output/$1.$2/summary.json"
}
# middle COLUMN FILE NAME: median, and where the runs differ, least and most.
middle() {
  awk -F, -v column="$1" -v name="$3" '
    NR == 1 { for (i = 1; i <= NF; ++i) if ($i == column) c = i; next }
    $1 == name && $c != "" { v[++n] = $c + 0 }
    END { if (n == 0) { print "-"; exit }
          for (i = 1; i <= n; ++i) for (j = i + 1; j <= n; ++j) if (v[j] < v[i]) { t = v[i]; v[i] = v[j]; v[j] = t }
          format = v[n] >= 100 ? "%.0f" : "%.3g"
          printf format, v[int((n + 1) / 2)]; if (n > 1) printf " (" format " to " format ")", v[1], v[n] }' "$2"
}
