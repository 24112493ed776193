#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Runs the demo, and reads the private memory of its processes each second. Fails if the memory of
# an end or of the link has grown by more than $allowed since the first minute.
# Usage: memory.sh [MINUTES [OPTIONS OF THE DEMO]]
set -euo pipefail
root=$(cd "$(dirname "$0")/../../.." && pwd)
seconds=$((60 * ${1:-4}))
[ $# = 0 ] || shift
# The allowed growth [KiB]. The memory may grow a little, because the allocator may use pages that
# it has not used before.
allowed=1024
work=$(mktemp -d)
trap 'kill ${demo:-} 2>/dev/null || true; rm -rf "$work"' EXIT

"$root/pipelines/demo.sh" --no-install --duration "$seconds" --no-plots --output "$work/out" "$@" >"$work/log" 2>&1 &
demo=$!
while kill -0 $demo 2>/dev/null; do
  for pid in $demo $(pgrep -P $demo || true); do
    name=$(tr '\0' ' ' <"/proc/$pid/cmdline" 2>/dev/null | awk '{ n = split($1, path, "/"); print path[n] "-" $2 }' | sed 's/--.*//; s/-$//') || continue # it has ended
    memory=$(awk '/^RssAnon/ { print $2 }' "/proc/$pid/status" 2>/dev/null || true)
    [ -z "$memory" ] || echo "$name $SECONDS $memory"
  done
  sleep 1
done >"$work/samples"
wait $demo || { tail -5 "$work/log"; echo "FAILED: the demo does not hold" >&2; exit 1; }

# The last two seconds are left out, because the processes of the demo end then.
awk -v allowed="$allowed" '
  $1 !~ /^lidar/ { next }
  !($1 in start) { start[$1] = $2 }
  { age = $2 - start[$1]; n[$1]++; value[$1, n[$1]] = $3; at[$1, n[$1]] = age }
  END {
    for (name in n) {
      last = at[name, n[name]]; early = late = 0
      for (i = 1; i <= n[name]; ++i) {
        if (at[name, i] <= 60 && value[name, i] > early) early = value[name, i]
        if (at[name, i] > 60 && at[name, i] < last - 2 && value[name, i] > late) late = value[name, i]
      }
      grown = late - early; judged = name ~ /run/ ? "(keeps the report)" : grown > allowed ? "FAILED" : "holds"
      printf "%-20s first minute %8.1f MB at most, then until second %d %8.1f MB at most: %+6.1f MB  %s\n", name, early / 1024, last, late / 1024, grown / 1024, judged
      bad += judged == "FAILED"
    }
    exit bad > 0
  }' "$work/samples"
