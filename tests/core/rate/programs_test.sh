#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Tests lidar-train and lidar-eval as a user calls them: output, files, exit codes.
set -eu
train=$(realpath "$1")
eval=$(realpath "$2")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
scene=synth:os0-32:street:512

fail() { echo "FAILED: $*"; exit 1; }
refused() {  # expects a message on standard error, and an exit code other than zero
  if "$@" >out.txt 2>error.txt; then fail "accepted: $*"; fi
  test -s error.txt || test -s out.txt || fail "no message: $*"
}

"$train" --help | grep -q SOURCE
"$eval" --help | grep -q bounds
"$train" $scene --scans 4 --samples 30 --modes range-draco,xyz-sequential,xyz-kd0,xyz-kd2,xyz-kd4,xyz-kd6 \
  -o model.json | grep -q 'paper, xyz' || fail "no report of the fit"
grep -q '"gst-lidar-rate-model"' model.json || fail "no model file"

"$eval" bounds $scene --scans 1 --errors 0.02,0.05 --csv bounds.csv | grep -q r_min || fail bounds
test "$(wc -l <bounds.csv)" -eq 5 || fail "bounds.csv has $(wc -l <bounds.csv) lines"
"$eval" rd $scene $scene --scans 1 --errors 0.02,0.05 --slices 1 --csv rd.csv --plot rd.png >/dev/null
head -c 4 rd.png | grep -q PNG || fail "no plot"
"$eval" predict $scene --scans 2 --samples 5 --model model.json | grep -q range- || fail predict
"$eval" track $scene --scans 3 --length 20 --model model.json --csv t.csv --plot t.png >/dev/null
for profile in steady walk jump; do
  test "$(wc -l <t-$profile.csv)" -eq 21 || fail "t-$profile.csv"
  test -s t-$profile.png || fail "t-$profile.png"
done
printf '0 2\n1 1\n' >targets.txt
"$eval" track $scene --scans 3 --targets targets.txt --rate-model paper --open-loop | grep -q recorded || fail recorded

refused "$train"
refused "$train" none.pcap
refused "$train" $scene --modes no-such-mode
refused "$train" $scene --min-step 0.5 --max-step 0.1
refused "$train" $scene --scans 2 --samples 20 --modes xyz-kd6 -o /no/such/folder/model.json
refused "$eval"
refused "$eval" bounds synth:os1-64:moon
refused "$eval" track $scene --model targets.txt
refused "$eval" track $scene --profiles dance
refused "$eval" rd $scene --scans 1 --errors 0.02 --slices 1 --plot /no/such/folder/x.png
echo OK
