#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Measures the drive of experiment c over a link without ECN. Its queue is a FIFO of 100 ms that
# marks no packets.
set -euo pipefail
. "$(dirname "$0")/common.sh" "$@"
. "$here/network.sh"

streams <<TEXT
c
no-ecn --no-l4s
TEXT
{ echo "$row_header"; rows c no-ecn; } >"$csv"
plot <<TEXT
set xlabel 'time [s]'; set ylabel 'queue [ms]'
plot '$output/c.1/timeline.csv' skip 1 using 1:6 with lines title 'L4S', '$output/no-ecn.1/timeline.csv' skip 1 using 1:6 with lines title 'no ECN'
TEXT
of() { echo "p95 capture to cloud $(middle cloud_p95_ms "$csv" "$1") ms, $(middle complete "$csv" "$1") scans whole, ATE $(middle ate_m "$csv" "$1") m"; }
verdict "with L4S $(of c); without ECN $(of no-ecn)"
