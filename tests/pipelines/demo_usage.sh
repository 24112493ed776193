#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Wrong use of the demo: the exit code, and a message that says what to do.
set -uo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failed=0

# expect CODE TEXT [options]: the demo ends with CODE and prints TEXT.
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
echo "not json" >"$folder/metadata.json"
echo "not a capture" >"$folder/capture.pcap"
expect 2 "--max-eror" --max-eror 1
expect 2 "--pcap" --metadata "$folder/metadata.json"
expect 2 "--drive" --drive --steps 1,2
expect 2 "os1-64" --model os9-64
expect 2 "no-such-file" --trace no-such-file
expect 2 "--rate" --rate 5 --steps 1,2
expect 1 "line 1: expected two numbers" --trace "$folder/trace.txt"
expect 1 "--start-bitrate must not be above --max-bitrate" --start-bitrate 9 --max-bitrate 8
expect 1 "the sender ended early" --pcap "$folder/capture.pcap" --metadata "$folder/metadata.json"
expect 0 "--duration" --help
exit $failed
