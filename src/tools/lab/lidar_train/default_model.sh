#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# usage: default_model.sh LIDAR_TRAIN CAPTURES [MODES] >src/rate/default_model.json
# Fits the model that is compiled into the plugin. CAPTURES is the folder tests/data/ouster. MODES
# is a comma-separated list. If it is given, only the adaptive model of these modes is fitted.
set -euo pipefail
train=$1 captures=$2 modes=${3:-}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
sources=(synth:os0-32:street synth:os1-64:street synth:os1-64:tunnel synth:os1-64:field
  synth:os1-128:street synth:os2-64:field "$captures/OS-0-32-U1_v2.2.0_1024x10.pcap"
  "$captures/OS-0-128-U1_v2.3.0_1024x10.pcap" "$captures/OS-1-32-G_v2.1.1_1024x10.pcap"
  "$captures/OS-1-128_v2.3.0_1024x10_lb_n3.pcap,$captures/OS-1-128_v2.3.0_1024x10.json")
options=(--scans 5 --samples 60 --slices "1,2,4,8")
"$train" "${sources[@]}" "${options[@]}" --model adaptive --intensity-bits 8 -o "$folder/adaptive" \
  ${modes:+--modes "$modes"} \
  --description "lidartestsrc (street, tunnel, field) and captures of the Ouster SDK (BSD-3-Clause)" >&2
if [ -n "$modes" ]; then cat "$folder/adaptive"; exit; fi
"$train" "${sources[@]}" "${options[@]}" --model paper --intensity-bits 5 -o "$folder/paper" >&2
jq -S -s '.[0] * {paper: .[1].paper}' "$folder/adaptive" "$folder/paper"
