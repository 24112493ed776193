# SPDX-License-Identifier: LGPL-2.1-or-later
# To be sourced by the experiments that use a network. They run sender, link and receiver with SLAM
# in real time.

# path_of NAME: sets `path` to the options of the link. If NAME ends in @TRACE, the link uses the
# --trace with that name. Otherwise it uses the first --trace, or a generated drive if there is no
# --trace.
path_of() {
  local trace
  path=(--drive --rate "$rate")
  for trace in "${traces[@]}"; do
    [[ $1 == *@* && $1 != *@$(basename "$trace" .txt) ]] || { path=(--trace "$trace"); return; }
  done
}
# stream NAME RUN [options of the demo]: runs the demo, and writes its report to $output/NAME.RUN. A
# run whose guarantees are broken or whose stream is poor is a result and not a failure.
stream() {
  local name=$1 run=$2 folder=$output/$1.$2 path
  shift 2
  path_of "$name"
  [ -f "$folder/summary.json" ] && [ "$folder/summary.json" -nt "$output/started" ] && return
  "$tools/lidar-demo" run --slam --no-plots --duration $seconds --model os0-32 --scene town \
    --speed $speed --seed $((seed + run - 1)) --max-error 0.05 --output "$folder" "${path[@]}" \
    "$@" >"$folder.log" 2>&1 || [ -f "$folder/summary.json" ] ||
    { tail -5 "$folder.log" >&2; return 1; }
}
# streams: reads lines 'NAME [options of the demo]' from standard input, and runs each of them $runs
# times. At most $parallel runs are active at a time.
streams() {
  local lines run line pid pids=() failed=0
  mapfile -t lines
  for run in $(seq "$runs"); do
    for line in "${lines[@]}"; do
      [ "$(jobs -rp | wc -l)" -lt "$parallel" ] || wait -n || true
      # shellcheck disable=SC2086
      stream ${line%% *} "$run" ${line#"${line%% *}"} &
      pids+=($!)
    done
  done
  for pid in "${pids[@]}"; do wait "$pid" || failed=1; done
  return $failed
}
# The codec of the paper: Draco on x, y and z, with q bits over the cube.
paper_codec="--encoder dracoenc --geometry xyz"
[ -f "$output/started" ] || touch "$output/started"

# uncompressed RUN: prints the ATE of the same drive when its scans are neither encoded nor sent.
uncompressed() {
  local file=$output/uncompressed.$1.json
  [ -f "$file" ] && [ "$file" -nt "$output/started" ] ||
    "$tools/lidar-eval" slam synth:os0-32:town --json --speed $speed --scans $scans \
      --seed $((seed + $1 - 1)) >"$file" 2>/dev/null
  jq -r .error.ate_rmse_m "$file"
}

# row NAME RUN: prints the results of a run as a line of the table. $row_header names its columns.
row_header="name,run,scans,complete,oracle,skipped,slices_lost,rate_mbps,max_error_m,cloud_p95_ms,pose_p95_ms,ate_m,ate_uncompressed_m,now_rmse_m,now_p95_m,pauses,late_p95_ms,encode_p95_ms"
# pauses FOLDER: prints how often the edge computed no pose for half a second or more.
pauses() { awk -F, 'NR > 2 && $1 - last > 5 { ++n } { last = $1 } END { print n + 0 }' "$1/poses.csv"; }
row() {
  jq -r --arg name "$1" --arg run "$2" --arg plain "$(uncompressed "$2")" \
    --arg now "$("$here/figures.py" now "$output/$1.$2")" --arg pauses "$(pauses "$output/$1.$2")" '[$name, $run, .scans_captured,
    .scans_complete, (.oracle.scans_complete // ""), .scans_skipped, .slices_lost, (.mean_rate_bps / 1e6),
    .max_error_m, .capture_to_cloud_ms.p95, .slam.capture_to_pose_ms.p95, (.slam.ate_rmse_m // ""),
    $plain, $now, $pauses, .stages_ms.capture.p95, .stages_ms.encode.p95] | join(",")' "$output/$1.$2/summary.json"
}
# rows NAME...: prints the row of each run of each NAME.
rows() {
  local name run
  for name in "$@"; do
    for run in $(seq "$runs"); do row "$name" "$run"; done
  done
}
# middle COLUMN FILE NAME: prints the median of a column over the runs of NAME. If there are several
# runs, prints the least and the greatest value, too.
middle() {
  awk -F, -v column="$1" -v name="$3" '
    NR == 1 { for (i = 1; i <= NF; ++i) if ($i == column) c = i; next }
    $1 == name && $c != "" && $c != "nan" { v[++n] = $c + 0 }
    END { if (n == 0) { print "-"; exit }
          for (i = 1; i <= n; ++i) for (j = i + 1; j <= n; ++j) if (v[j] < v[i]) { t = v[i]; v[i] = v[j]; v[j] = t }
          format = v[n] >= 100 ? "%.0f" : "%.3g"
          printf format, (v[int((n + 1) / 2)] + v[int(n / 2) + 1]) / 2; if (n > 1) printf " (" format " to " format ")", v[1], v[n] }' "$2"
}
