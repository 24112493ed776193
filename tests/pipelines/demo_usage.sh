#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Tests the command line of the demo: its exit codes, its error messages, and its reaction to
# signals.
set -uo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failed=0

# expect CODE TEXT [options]: expects that the demo ends with exit code CODE and prints TEXT.
expect() {
  local code=$1 text=$2 output status
  shift 2
  output=$(BUILD_DIR=$MESON_BUILD_ROOT "$root/pipelines/demo.sh" --no-install --no-build --output "$folder/out" "$@" 2>&1)
  status=$?
  if [ "$status" != "$code" ] || ! grep -qF -- "$text" <<<"$output"; then
    printf 'demo.sh %s: code %s instead of %s, or no "%s" in:\n%s\n' "$*" "$status" "$code" "$text" "$output" >&2
    failed=1
  fi
}

echo "0 five" >"$folder/trace.txt"
echo "0 5" >"$folder/good.txt"
echo "not json" >"$folder/metadata.json"
echo "not a capture" >"$folder/capture.pcap"
expect 2 "--max-eror" --max-eror 1
expect 2 "--pcap" --metadata "$folder/metadata.json"
expect 2 "--drive" --drive --steps 1,2
expect 2 "os1-64" --model os9-64
expect 2 "no-such-file" --trace no-such-file
expect 2 "--rate" --rate 5 --steps 1,2
expect 2 "line 1: expected two numbers" --trace "$folder/trace.txt"
expect 2 "--trace must be given once for each of the --links" --links 2 --trace "$folder/good.txt"
expect 2 "lidarenc codes ranges" --geometry xyz --encoder lidarenc
expect 2 "--start-bitrate must not be above --max-bitrate" --start-bitrate 9 --max-bitrate 8
expect 1 "the sender ended early" --pcap "$folder/capture.pcap" --metadata "$folder/metadata.json"
expect 0 "--duration" --help
# The second link cannot write its packets, because a folder has the name of the file.
mkdir -p "$folder/out/packets2.csv/kept"
expect 1 "packets2.csv" --links 2

# Sends a signal to a receiver that has received the end of the stream, but still writes its clouds.
# The signal must not stop it.
mkfifo "$folder/clouds"
# shellcheck source=pipelines/environment.sh
BUILD_DIR=$MESON_BUILD_ROOT source "$root/pipelines/environment.sh"
"$MESON_BUILD_ROOT/src/tools/lidar-demo" receive "lidartestsrc model=os0-32 mode=512x10 is-live=false slices-per-scan=1 \
  num-buffers=3 ! lidarenc ! lidardec name=decoder ! fakesink" >"$folder/records" 3>"$folder/clouds" &
receiver=$!
exec 4<"$folder/clouds"
for _ in {1..300}; do
  [ "$(grep -c '"decoded"' "$folder/records")" -lt 3 ] || break
  sleep 0.1
done
sleep 0.5
kill -INT $receiver
sleep 0.2
clouds=$(wc -c <&4)
wait $receiver || { echo "the receiver ended with $?" >&2; failed=1; }
all=$((3 * (20 + 32 * 512 * 12)))
[ "$clouds" = "$all" ] || { echo "the receiver wrote $clouds bytes of clouds instead of $all" >&2; failed=1; }
exit $failed
