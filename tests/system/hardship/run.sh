#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Builds the programs, and runs the hardships for longer than the test of the suite does. Processes
# are stopped for 20 s, for example.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)

args=(--seconds 20 --stop-seconds 20)
while [ $# -gt 0 ]; do
  case $1 in
    --seconds | --stop-seconds | --only) [ $# -ge 2 ] || { echo "$1 takes a value." >&2; exit 2; }; args+=("$1" "$2"); shift ;;
    *) echo "Usage: tests/system/hardship/run.sh [--seconds N] [--stop-seconds N] [--only PART_OF_A_NAME]
BUILD_DIR names the build." >&2
       [ "$1" = --help ] && exit 0 || exit 2 ;;
  esac
  shift
done

. "$here/../../support/victim_env.sh"
exec "$here/hardship.py" "${victim_args[@]}" --tools "$build/src/tools" "${args[@]}"
