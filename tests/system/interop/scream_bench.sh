#!/bin/bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Runs scream-bench against itself over IPv4 and over IPv6. The feedback goes to the source port of
# the media, or to a port that an option names. Checks that each end stops on SIGINT and writes its
# summary.
#
#   tests/system/interop/scream_bench.sh BUILD
set -euo pipefail
build=$1
port=$(python3 "$(dirname "${BASH_SOURCE[0]}")/../../support/ports.py" 2)
folder=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$folder"' EXIT

# check NAME ADDRESS TX_OPTIONS RX_OPTIONS END: runs a sender and a receiver. END (sender or
# receiver) gets the first SIGINT.
check() {
  local bench=$build/src/tools/scream-bench
  "$bench" rx --address "$2" --port "$port" --summary "$folder/rx.json" --log "$folder/rx.csv" $4 >"$folder/rx.txt" &
  local rx=$!
  for _ in $(seq 100); do
    grep -q ":$(printf %04X "$port") " /proc/net/udp /proc/net/udp6 && break
    sleep 0.1
  done
  "$bench" tx --host "$2" --port "$port" --init-bitrate 1M --max-bitrate 3M --summary "$folder/tx.json" --log "$folder/tx.csv" $3 >"$folder/tx.txt" &
  local tx=$!
  sleep 4
  if [ "$5" = receiver ]; then kill -INT $rx; wait $rx; fi
  kill -INT $tx; wait $tx
  if [ "$5" = sender ]; then wait $rx; fi  # the receiver ends when the sender ends
  python3 - "$1" "$folder" <<'PYTHON'
import csv, json, sys
name, folder = sys.argv[1:]
tx, rx = (json.load(open(f"{folder}/{end}.json")) for end in ("tx", "rx"))
lines = [len(open(f"{folder}/{end}.txt").read().splitlines()) for end in ("tx", "rx")]
rows = list(csv.DictReader(open(f"{folder}/tx.csv")))
print(name, tx["mean_rate_bps"], rx["frames"], lines, len(rows))
assert rx["frames"] >= 50 and rx["packets"] >= 0.9 * tx["packets_sent"], (tx, rx)
assert tx["packets_lost"] <= 0.1 * tx["packets_sent"], tx
assert min(lines) >= 2 and len(rows) >= 10
assert float(rows[-1]["rtt_ms"]) > 0, "no feedback"
PYTHON
}

# Starts the sender without a receiver. It must fail, because it gets no answer.
status=0
"$build/src/tools/scream-bench" tx --host 127.0.0.1 --port "$port" --duration 1 >/dev/null 2>"$folder/tx.err" || status=$?
[ $status = 1 ] && grep -q "No feedback arrived" "$folder/tx.err" || { echo "tx without rx: exit code $status"; cat "$folder/tx.err"; exit 1; }

check "IPv4" 127.0.0.1 "" "" sender
check "IPv6" ::1 "--frame-jitter 20 --fps 30" "" receiver
check "feedback to a port that is named" 127.0.0.1 "--bind-address 127.0.0.1 --bind-port $((port + 1)) --ecn off" "--feedback 127.0.0.1:$((port + 1))" sender
