#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Tests that pipelines/view.sh, pipelines/record.sh and pipelines/play.sh write the files that their
# help describes.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
. "$root/pipelines/environment.sh"
passed=0
failed=0

# check NAME COMMAND...: runs the command, and counts it as passed or failed.
check() {
  local name=$1
  shift
  if "$@" >"$folder/log" 2>&1; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "FAILED: $name"
    cat "$folder/log"
  fi
}
starts_with() { [ "$(head -c "${#2}" "$1")" = "$2" ]; }
is_png() { [ "$(head -c 4 "$1" | tail -c 3)" = PNG ] && [ "$(stat -c %s "$1")" -gt 5000 ]; }
counts() { [ "$(find "$1" -name "$2" | wc -l)" = "$3" ]; }

small="lidartestsrc model=os1-32 mode=512x10"
check "view.sh runs" "$root/pipelines/view.sh" --scan 2 --output "$folder/my view" "$small"
for view in top perspective range; do
  check "$view.png is a picture" is_png "$folder/my view/$view.png"
done
for format in pcd pcd-text ply ply-text bin; do
  check "record.sh writes $format" "$root/pipelines/record.sh" --scans 3 --format $format \
    --output "$folder/$format" "$small"
  check "$format has three scans" counts "$folder/$format" "scan*" 3
  check "$format has a pose for each slice" counts "$folder/$format" trajectory.tum 1
done
check "a PCD file begins as one" starts_with "$folder/pcd/scan000002.pcd" "# .PCD v0.7"
check "a PLY file begins as one" starts_with "$folder/ply/scan000002.ply" ply
check "a raw scan has 32 x 512 points of 20 bytes" \
  [ "$(stat -c %s "$folder/bin/scan000000.bin")" = $((32 * 512 * 20)) ]
check "record.sh takes a folder with a space" "$root/pipelines/record.sh" --scans 1 --output "$folder/my scans" "$small"
check "and writes there" counts "$folder/my scans" "scan*" 1
if gst-inspect-1.0 mcapsink >/dev/null 2>&1; then
  for format in slices clouds; do
    check "record.sh records $format" "$root/pipelines/record.sh" --seconds 600 --piece 1 --format $format \
      --output "$folder/$format" "$small num-buffers=200"
    check "$format come in pieces" [ -s "$folder/$format/rec-00001.mcap" ]
  done
  count_pieces() { find "$folder/slices" -name 'rec-*.mcap' | wc -l; }
  pieces=$(count_pieces) first=$(md5sum "$folder/slices/rec-00000.mcap")
  check "record.sh records beside what is there" "$root/pipelines/record.sh" --seconds 1 --output "$folder/slices" "$small"
  check "and adds a file" [ "$(count_pieces)" -gt "$pieces" ]
  check "and leaves the others" [ "$(md5sum "$folder/slices/rec-00000.mcap")" = "$first" ]
  fails() { ! "$@"; }
  check "record.sh fails where nothing comes" fails "$root/pipelines/record.sh" --seconds 1 --output "$folder/none" \
    "lidartestsrc num-buffers=0 model=os1-32"
  head -c -1000 "$folder/slices/rec-00000.mcap" >"$folder/cut.mcap"
  says() { local text=$1; shift; "$@" 2>&1 | grep -q "$text"; }
  check "play.sh says that a file broke off" says "were not closed" "$root/pipelines/play.sh" --to none "$folder/cut.mcap"
  check "play.sh plays slices to files" "$root/pipelines/play.sh" --to pcd --output "$folder/played" \
    "$folder/slices/rec-%05d.mcap"
  check "play.sh plays clouds to files" "$root/pipelines/play.sh" --to ply --topic /points --decoder none \
    --output "$folder/played" "$folder/clouds/rec-%05d.mcap"
  for file in scan000005.pcd scan000005.ply; do check "$file is there" [ -s "$folder/played/$file" ]; done
  check "play.sh sends slices" "$root/pipelines/play.sh" --send "127.0.0.1:$(python3 "$root/tests/support/ports.py" 1)" "$folder/slices/rec-00000.mcap"
fi
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
