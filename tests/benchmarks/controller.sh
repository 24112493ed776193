#!/usr/bin/env bash
# Runs all simulated cases of the controller for one commit, and prints which goals it meets and
# misses. With --ablation, prints how the results change without each part of the controller.
# usage: controller.sh BUILD [--ablation] [options of controller-goals]
set -eu
build=$1
shift
source=$(cd "$(dirname "$0")/../.." && pwd)
ninja -C "$build" tests/benchmarks/controller-goals >/dev/null
commit=$(git -C "$source" rev-parse --short HEAD 2>/dev/null || echo unknown)
changed=$(git -C "$source" status --porcelain -- src tests 2>/dev/null | head -1)
echo "commit $commit${changed:+, and changes that are not committed}"
begin=$SECONDS
"$build/tests/benchmarks/controller-goals" "$@"
echo "$((SECONDS - begin)) s on $(nproc) processors"
