#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# on_free_ports.sh COUNT SCRIPT [options]: runs a script of pipelines/. PORT in its environment, and PORT among its
# options, is the first of COUNT ports that are free. Its guarantees must hold (exit code 0, or 3 if little came, as on a
# busy machine).
set -euo pipefail
PORT=$(python3 "$(dirname "$0")/../support/ports.py" "$1")
export PORT
script=$2
shift 2
status=0
"$script" "${@/#PORT/$PORT}" || status=$?
[ "$status" = 3 ] || exit "$status"
