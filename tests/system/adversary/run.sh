#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Builds the programs, and runs the attacks on them for the given time.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)

args=(--seed "$RANDOM")
while [ $# -gt 0 ]; do
  case $1 in
    --minutes | --seed | --only) [ $# -ge 2 ] || { echo "$1 takes a value." >&2; exit 2; }; args+=("$1" "$2"); shift ;;
    *) echo "Usage: tests/system/adversary/run.sh [--minutes N] [--seed S] [--only PART_OF_A_NAME]
BUILD_DIR names the build, build-asan for example." >&2
       [ "$1" = --help ] && exit 0 || exit 2 ;;
  esac
  shift
done

. "$here/../../support/victim_env.sh"
exec "$here/adversary.py" "${victim_args[@]}" "${args[@]}"
