#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Compares the plugins of this build with docs/plugins_cache.json, so that a change of a pad or a
# property does not remain unnoticed.
# Usage: inspect_test.sh PROGRAM [--update]
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
snapshot=$root/docs/plugins_cache.json
now=$(mktemp)
trap 'rm -f "$now" "$now.kept"' EXIT
"$1" >"$now"

if [ "${2:-}" = --update ]; then
  # The entries of plugins that are not part of this build are kept.
  [ -f "$snapshot" ] || echo '{}' >"$snapshot"
  jq -s '.[0] * {} | . + $new[0] | to_entries | sort_by(.key) | from_entries' \
    --slurpfile new "$now" "$snapshot" >"$now.kept"
  cp "$now.kept" "$snapshot"
  echo "wrote $snapshot"
  exit 0
fi

# Compares only the plugins of this build. A plugin is not built if a library that it needs is
# missing. Adds 0 to each number, because newer versions of jq print 1.0 as 1 only after a
# calculation.
numbers='def numbers_as_values: walk(if type == "number" then . + 0 else . end);'
jq --slurpfile new "$now" "$numbers"' with_entries(select(.key as $k | $new[0] | has($k))) | numbers_as_values' \
  "$snapshot" >"$now.kept"
if ! diff -u --label docs/plugins_cache.json --label "the plugins as built" "$now.kept" <(jq "$numbers numbers_as_values" "$now"); then
  echo "If this is meant: tests/inspect/update.sh, and commit docs/plugins_cache.json." >&2
  exit 1
fi
