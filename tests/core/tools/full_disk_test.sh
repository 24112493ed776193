#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Tests programs on a full disk. They must report the error, fail, and leave neither an empty nor a truncated file.
# A limit on the size of files simulates the full disk.
# usage: full_disk_test.sh PROGRAM ...   (lidar-link, ouster-replay, then lidar-eval)
set -uo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
trap '' XFSZ # a write past the limit is an error, not a signal
failed=0

# interrupted PROGRAM ...: starts a program and interrupts it after its first line of output.
interrupted() {
  local pid
  coproc LINK { exec "$@"; }
  pid=$LINK_PID
  read -r <&"${LINK[0]}" && kill -INT "$pid"
  wait "$pid"
}

# expect_clean_failure KIB PROGRAM ...: expects the program to fail with an error that names a file in
# the folder, and to leave no file there.
expect_clean_failure() {
  local limit=$1 output status
  shift
  output=$(ulimit -f "$limit" && "$@" 2>&1)
  status=$?
  if [ "$status" -eq 0 ] || [ "$status" -ge 128 ] || [[ $output != *"cannot write $folder/"* ]]; then
    echo "status $status of: $*"
    echo "$output"
    failed=1
  fi
  if [ -n "$(find "$folder" -type f ! -name source.pcap ! -name source.json)" ]; then
    echo "left by: $*"
    ls -l "$folder"
    failed=1
  fi
  find "$folder" -type f ! -name source.pcap ! -name source.json -delete
}

for program in "$@"; do
  case $(basename "$program") in
    lidar-link)
      link=("$program" --listen 127.0.0.1:0 --forward 127.0.0.1:9 --json-lines)
      expect_clean_failure 0 interrupted "${link[@]}" --summary "$folder/summary.json"
      expect_clean_failure 0 interrupted "${link[@]}" --log "$folder/log.csv"
      ;;
    ouster-replay)
      "$program" --synthesize os0-32 --mode 512x10 --scans 3 --write-pcap "$folder/source.pcap" \
        --write-metadata "$folder/source.json" || failed=1
      for limit in 0 64; do
        expect_clean_failure "$limit" "$program" --synthesize os0-32 --mode 512x10 --scans 3 \
          --write-pcap "$folder/drive.pcap"
      done
      expect_clean_failure 0 "$program" --synthesize os0-32 --scans 1 --write-pcap "$folder/drive.pcap" \
        --write-metadata "$folder/drive.json"
      ;;
    lidar-eval)
      for limit in 0 64; do
        expect_clean_failure "$limit" "$program" to-pcap "$folder/source.pcap" --scans 2 -o "$folder/drive.pcap"
      done
      expect_clean_failure 0 "$program" rd "$folder/source.pcap" --scans 1 --errors 0.02,0.05 --csv "$folder/rd.csv"
      # A command that fails before its first row must not leave a file either.
      "$program" bounds "$folder/nothing.pcap" --csv "$folder/bounds.csv" >"$folder/source.json" 2>&1 && failed=1
      [ ! -e "$folder/bounds.csv" ] || { echo "bounds.csv is left"; failed=1; }
      ;;
  esac
done
exit "$failed"
