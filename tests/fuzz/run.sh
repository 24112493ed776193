#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Builds the fuzz targets with clang, AddressSanitizer and UBSan, and runs each of them for the
# given time.
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(dirname "$(dirname "$here")")

usage() {
  cat <<EOF
Usage: tests/fuzz/run.sh (--minutes N | --hours N) [options] [TARGET...]

  --minutes N, --hours N  time for each target (all of them where none is named)
  --work DIR              grown corpora, findings and logs (default: build-fuzz/work)
  --jobs N                targets at a time (default 1)
  --coverage              no fuzzing: report how much of src/ and ext/ the corpora reach
  --merge                 no fuzzing: add to the committed corpora what grown ones reach beyond them

Findings are left in DIR/TARGET-findings; the exit status is 1 where there are any.
EOF
}

seconds=0
jobs=1
mode=fuzz
work=
targets=()
while [ $# -gt 0 ]; do
  case $1 in
    --minutes | --hours | --work | --jobs)
      [ $# -ge 2 ] || { usage >&2; exit 2; }
      case $1 in
        --minutes) seconds=$(awk "BEGIN { print int($2 * 60) }") ;;
        --hours) seconds=$(awk "BEGIN { print int($2 * 3600) }") ;;
        --work) work=$2 ;;
        --jobs) jobs=$2 ;;
      esac
      shift ;;
    --coverage) mode=coverage ;;
    --merge) mode=merge ;;
    -h | --help) usage; exit 0 ;;
    -*) echo "Unknown option '$1'." >&2; usage >&2; exit 2 ;;
    *) targets+=("$1") ;;
  esac
  shift
done
[ $mode != fuzz ] || [ "$seconds" -gt 0 ] || { usage >&2; exit 2; }

command -v clang++ >/dev/null && ls /usr/lib/llvm-*/lib/clang/*/lib/linux/libclang_rt.fuzzer-*.a >/dev/null 2>&1 || {
  echo "Fuzzing needs clang with its runtime: apt-get install clang libclang-rt-14-dev llvm-14" >&2
  exit 1
}
if [ $mode = coverage ]; then
  build=$root/build-fuzz-coverage
  flags="-fprofile-instr-generate,-fcoverage-mapping"
  sanitize=none
else
  build=$root/build-fuzz
  flags="-fsanitize=fuzzer-no-link"
  sanitize=address,undefined
fi
work=${work:-$root/build-fuzz/work}
mkdir -p "$work"
if [ ! -f "$build/build.ninja" ]; then
  CC=clang CXX=clang++ meson setup "$build" "$root" -Dfuzzing=true -Dwerror=false -Db_lundef=false \
    -Db_sanitize=$sanitize -Dcpp_args="$flags" -Dcpp_link_args="${flags%%-fcov*}" -Dbenchmarks=disabled \
    -Dview=disabled -Doptimization=1 >"$work/setup.log" 2>&1 || { tail -20 "$work/setup.log"; exit 1; }
fi
mapfile -t all < <(ninja -C "$build" -t targets all | sed -n 's|^tests/fuzz/fuzz_\([a-z_]*\):.*|\1|p' | sort)
[ ${#targets[@]} -gt 0 ] || targets=("${all[@]}")
ninja -C "$build" "${targets[@]/#/tests/fuzz/fuzz_}" >"$work/build.log" 2>&1 ||
  { grep -A8 -E 'FAILED|error:' "$work/build.log" | head -40; exit 1; }

export ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1
export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1

fuzz_one() {
  local target=$1
  local grown=$work/$target findings=$work/$target-findings
  mkdir -p "$grown" "$findings"
  # No input may need more than a second or a gigabyte. The time limit is 5 s, because the
  # sanitizers make the code slower.
  "$build/tests/fuzz/fuzz_$target" "$grown" "$here/corpus/$target" -max_total_time="$seconds" \
    -timeout=5 -rss_limit_mb=1024 -max_len=65536 -print_final_stats=1 -artifact_prefix="$findings/" \
    >"$work/$target.log" 2>&1
  local status=$?
  local executions coverage
  executions=$(sed -n 's/stat::number_of_executed_units: //p' "$work/$target.log")
  coverage=$(grep -oE 'cov: [0-9]+' "$work/$target.log" | tail -1 | cut -c6-)
  printf '%-16s %6d s %12s runs %6s edges %s\n' "$target" "$seconds" "${executions:-?}" "${coverage:-?}" \
    "$([ $status = 0 ] && echo "no finding" || echo "FINDING: see $work/$target.log")"
  return $status
}

# merge_one TARGET: adds to the committed corpus the inputs of the grown corpus that cover more
# code. Adds the smallest inputs first, and at most 64 kB of them, so that the committed corpus
# remains small.
merge_one() {
  local target=$1 minimal=$work/$target-minimal
  rm -rf "$minimal"
  mkdir -p "$minimal" "$work/$target"
  "$build/tests/fuzz/fuzz_$target" -merge=1 "$minimal" "$here/corpus/$target" "$work/$target" >"$work/$target-merge.log" 2>&1
  local total=0
  while read -r size path; do
    total=$((total + size))
    [ $total -le 65536 ] || break
    cp "$path" "$here/corpus/$target/$(basename "$path" | cut -c1-40)"
  done < <(find "$minimal" -type f -printf '%s %p\n' | sort -n)
}

coverage_report() {
  local profiles=() objects=()
  for target in "${targets[@]}"; do
    LLVM_PROFILE_FILE=$work/$target.profraw "$build/tests/fuzz/fuzz_$target" -runs=0 \
      "$here/corpus/$target" "$work/$target" >/dev/null 2>&1
    llvm-profdata-14 merge -sparse "$work/$target.profraw" -o "$work/$target.profdata"
    echo "== $target"
    llvm-cov-14 report "$build/tests/fuzz/fuzz_$target" -instr-profile="$work/$target.profdata" \
      "$root/src" "$root/ext" 2>/dev/null | awk 'NR > 2 && $8 != "0" && NF > 9 { print $1, $10 }' |
      grep -v ' 0.00%' | column -t
  done
}

failed=0
case $mode in
  coverage) for t in "${targets[@]}"; do mkdir -p "$work/$t"; done; coverage_report ;;
  merge) for t in "${targets[@]}"; do merge_one "$t"; done ;;
  fuzz)
    for t in "${targets[@]}"; do
      while [ "$(jobs -rp | wc -l)" -ge "$jobs" ]; do wait -n || failed=1; done
      fuzz_one "$t" &
    done
    while [ -n "$(jobs -rp)" ]; do wait -n || failed=1; done ;;
esac
exit $failed
