#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Checks that the file exists to which each relative link of the README and the docs points.
set -uo pipefail
cd "$1" || exit 1
status=0
while IFS= read -r page; do
  while IFS= read -r link; do
    target=$(dirname "$page")/${link%%#*}
    [ -e "$target" ] || { echo "$page: no such file: $link" >&2; status=1; }
  done < <(grep -oE '\]\([^)#][^)]*\)' "$page" | sed 's/^](//; s/)$//' | grep -vE '^[a-z]+:')
done < <(find README.md CHANGELOG.md docs -name '*.md')
exit $status
