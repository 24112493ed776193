#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Makes every figure of docs/paper.md. Each experiment writes a table, a plot and a line with its
# result.
set -uo pipefail
. "$(dirname "$0")/common.sh" "$@"

touch "$output/started"
failed=0
for script in "$here"/[a-i]_*.sh; do
  name=$(basename "$script")
  [[ $only == *"${name%%_*}"* ]] || continue
  began=$SECONDS
  "$script" "${options[@]}" || { echo "${name%%_*}: FAILED"; failed=1; }
  echo "   ($((SECONDS - began)) s)" >&2
done
exit $failed
