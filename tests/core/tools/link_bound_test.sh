#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# lidar-trace --bound: a second link bridges the gaps of the first, and a text that is no trace is
# an error.
set -euo pipefail
trace=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$trace" --gap 1 --every 10 --duration 180 >"$folder/gaps.txt"
table=$("$trace" --rate 1.4 --duration 60 --bound "$folder/gaps.txt" --bound "$folder/gaps.txt@5")
whole() { awk -v row="$1" 'index($0, row) == 1 { print $(NF - 3) }' <<<"$table"; }
[[ $(whole "all, where whole first") == 100.00 ]] || { echo "two links lose scans: $table"; exit 1; }
awk -v one="$(whole "$folder/gaps.txt@5")" 'BEGIN { exit !(one > 80 && one < 95) }' || { echo "one link: $table"; exit 1; }
for bad in "$folder/none.txt" "$folder/gaps.txt@-1" "$0"; do
  if "$trace" --bound "$bad" >/dev/null 2>"$folder/error"; then echo "took $bad"; exit 1; fi
  grep -q "^lidar-trace: " "$folder/error" || { echo "no word about $bad"; exit 1; }
done
