#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Checks that the library exports exactly the symbols in its list for Debian. A lint compares that
# list with the headers.
# Usage: exported_symbols.sh LIBRARY LIST
set -euo pipefail
diff --label "the library" --label "$2" <(nm -D --defined-only --format=posix "$1" | cut -d' ' -f1 | LC_ALL=C sort) \
  <(sed -n 's/^ \([^ @]*\)@.*/\1/p' "$2" | LC_ALL=C sort)
