#!/bin/bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Runs the sender of this project against the receiver of EricssonResearch/scream, and their sender
# against the receiver of this project. The packets pass through lidar-link.
#
#   tests/system/interop/reference.sh FOLDER [BUILD]
#
# FOLDER contains scream_bw_test_tx and scream_bw_test_rx. The variable SCREAM_REFERENCE may name
# this folder, too. Without the folder the test is skipped (exit code 77). It needs root: the
# reference's sender binds the port number to which it sends, so it must run in a network namespace
# of its own.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
folder=${1:-${SCREAM_REFERENCE:-}}
build=${2:-${BUILD:-$here/../../../build}}
if [ -z "$folder" ] || [ ! -x "$folder/scream_bw_test_tx" ] || [ ! -x "$folder/scream_bw_test_rx" ]; then
  echo "skipped: give the folder of scream_bw_test_tx and scream_bw_test_rx (EricssonResearch/scream, cmake)"
  exit 77
fi
if [ "$(id -u)" != 0 ]; then
  echo "skipped: needs root for a network namespace"
  exit 77
fi
figures=$(mktemp)
trap 'rm -f "$figures"' EXIT
python3 "$here/../../benchmarks/scream_sockets.py" frames_8M_rtt40 --build "$build" --reference "$folder" --seconds "${SECONDS_EACH:-25}" \
  --port-offset 2000 --peers ours-ours,ours-reference,reference-reference,reference-ours --json "$figures"
python3 - "$figures" <<'PYTHON'
import json
import sys

rows = {(r["sender"], r["receiver"]): r for r in json.load(open(sys.argv[1]))}
failed = False
for sender in ("ours", "reference"):
    own = rows[sender, sender]
    mixed = rows[sender, "reference" if sender == "ours" else "ours"]
    rate = mixed["utilisation"] / own["utilisation"]
    queue = mixed["queue_ms"][0] - own["queue_ms"][0]
    good = 0.95 <= rate <= 1.05 and queue <= max(0.05 * own["queue_ms"][0], 1)
    failed |= not good
    print(f"{sender} sends: with the other receiver {100 * rate:.1f} % of the rate, median queue "
          f"{queue:+.2f} ms: {'good' if good else 'NOT WITHIN 5 % and 1 ms'}")
sys.exit(failed)
PYTHON
