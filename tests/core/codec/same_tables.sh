#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# usage: same_tables.sh TOOL CAPTURES COMMITTED
# The committed table is what the tool makes of the captures.
set -euo pipefail
"$1" "$2" | diff - "$3"
