#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# docs/plugins_cache.json says what the plugins show: a change of a pad or property is meant, or a mistake.
# Usage: inspect_test.sh PROGRAM [--update]
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
snapshot=$root/docs/plugins_cache.json
now=$(mktemp)
trap 'rm -f "$now" "$now.kept"' EXIT
"$1" >"$now"

if [ "${2:-}" = --update ]; then
  # Plugins that this build leaves out stay as they are.
  [ -f "$snapshot" ] || echo '{}' >"$snapshot"
  jq -s '.[0] * {} | . + $new[0] | to_entries | sort_by(.key) | from_entries' \
    --slurpfile new "$now" "$snapshot" >"$now.kept"
  cp "$now.kept" "$snapshot"
  echo "wrote $snapshot"
  exit 0
fi

# A plugin that needs a missing library is not built here, and not compared. Newer versions of jq keep
# 1.0 where it was not calculated.
numbers='def numbers_as_values: walk(if type == "number" then . + 0 else . end);'
jq --slurpfile new "$now" "$numbers"' with_entries(select(.key as $k | $new[0] | has($k))) | numbers_as_values' \
  "$snapshot" >"$now.kept"
if ! diff -u --label docs/plugins_cache.json --label "the plugins as built" "$now.kept" <(jq "$numbers numbers_as_values" "$now"); then
  echo "If this is meant: tests/inspect/update.sh, and commit docs/plugins_cache.json." >&2
  exit 1
fi

# Every element has a page that names its properties.
status=0
for element in $(jq -r '.[].elements | keys[]' "$now"); do
  page=$root/docs/elements/$element.md
  if [ ! -f "$page" ]; then
    echo "docs/elements/$element.md is missing" >&2
    status=1
    continue
  fi
  for property in $(jq -r --arg e "$element" '.[].elements[$e] // empty | .properties | keys[]' "$now"); do
    grep -qwF -- "$property" "$page" && continue
    echo "docs/elements/$element.md does not name the property $property" >&2
    status=1
  done
done
exit $status
