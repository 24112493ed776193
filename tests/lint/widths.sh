#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Checks that the lines of the README, the changelog and the docs have at most 100 characters.
# Tables, code blocks, and single words without a space (such as addresses) may be longer.
set -uo pipefail
cd "$1" || exit 1
mapfile -t pages < <(find . -name '*.md' -not -path './build*' -not -path './.git/*' -not -path '*/node_modules/*')
LC_ALL=C.UTF-8 perl -CSD -ne '
  if ($. == 1) { $code = 0 }
  if (/^\s*```/) { $code = !$code }
  elsif (!$code && !/^\s*\|/ && !/^    / && length > 101 && /\S\s+\S/) {
    print STDERR "$ARGV:$.: wider than 100 characters\n"; $bad = 1;
  }
  close ARGV if eof;
  END { exit($bad ? 1 : 0) }' "${pages[@]}"
