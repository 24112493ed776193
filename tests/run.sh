#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Installs missing packages, builds the tree, and runs every suite. The last line of the output is
# "N passed, N failed".
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(dirname "$here")

usage() {
  cat <<EOF
Usage: tests/run.sh [--suite NAME] [--no-install] [--no-sanitize] [--tsan] [--tidy]

Without options, lint, core, pipelines and bench run in a build for users, and sanitize in a second
build. Tests of elements and fuzz run in the second build only.

  --suite NAME    run one suite: lint, core, elements, pipelines, fuzz, bench, sanitize (elements,
                  fuzz, and core without long simulations and programs, under AddressSanitizer and
                  UBSan), or one that runs by name only: faults (eight minutes of broken networks and
                  SRTP, for an idle machine), peers (npm's MCAP, Cyclone DDS with its own types),
                  browser (foxglovesink's page in Chromium), viewers (it behind nginx, Caddy and
                  slow links, for an idle machine)
  --no-install    do not install Debian packages
  --no-sanitize   leave out the sanitizer build; elements and fuzz run in the build for users
  --tsan          also run core (without the same) and elements under ThreadSanitizer
  --tidy          also run clang-tidy over src, gst and ext
EOF
}

suites=(lint core elements pipelines fuzz bench)
sanitize=yes
tsan=no
tidy=no
install=yes
while [ $# -gt 0 ]; do
  case $1 in
    --suite)
      [ $# -ge 2 ] || { usage >&2; exit 2; }
      case $2 in
        sanitize) suites=() ;;
        lint | core | elements | pipelines | fuzz | bench | faults | peers | browser | viewers) suites=("$2"); sanitize=no ;;
        *) echo "No suite is called '$2'." >&2; usage >&2; exit 2 ;;
      esac
      shift ;;
    --no-install) install=no ;;
    --no-sanitize) sanitize=no ;;
    --tsan) tsan=yes ;;
    --tidy) tidy=yes ;;
    -h | --help) usage; exit 0 ;;
    *) echo "Unknown option '$1'." >&2; usage >&2; exit 2 ;;
  esac
  shift
done

sanitized="core elements fuzz"  # the suites that run under sanitizers
sanitized_job=
sanitized_result=
passed=0
failed=0
failures=
started=$SECONDS

# These suites do not run under sanitizers, because a sanitizer makes them many times slower. The
# code that they run is also run by other tests.
dear=(simulation programs)
without_dear=("${dear[@]/#/--no-suite=}")
# Tests of elements wait for half of their time, so more tests run in parallel than there are cores.
waiting=(--num-processes $((2 * $(nproc))))
# The time limits are long, because they only have to end tests that hang. A busy machine may make a
# test much slower.
patient=(--timeout-multiplier 40)

# Makes ccache use the list of headers that the compiler writes. ccache then needs no run of the
# preprocessor for a file that is not in the cache.
export CCACHE_DEPEND=${CCACHE_DEPEND:-1} CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS:-pch_defines,time_macros}

# targets DIR SUITE...: prints the targets that tests of the suites need, in the form that ninja
# expects. Leaves out the tests in $dear. If one of the suites is `product`, includes the tests in
# $dear and all default targets outside of tests/.
targets() {
  local dir=$1
  shift
  jq -rn --arg dir "$dir/" --arg suites "$*" --arg dear "${dear[*]}" \
    --slurpfile tests <(meson introspect "$dir" --tests) --slurpfile all <(meson introspect "$dir" --targets) '
    def of($names): any(.suite[]; sub(".*:"; "") | IN($names | splits(" ")));
    ($suites | contains("product")) as $product
    | [$tests[0][] | select(of($suites) and ($product or (of($dear) | not))) | .depends[]] as $needed
    | $all[0][]
    | select((.id | IN($needed[])) or ($product and .build_by_default and (.defined_in | contains("/tests/") | not)))
    | .filename[] | ltrimstr($dir)'
}

# build DIR SUITES [meson options]: configures DIR if it is not yet configured, and builds the
# targets that the suites need. The debug information has only line numbers, which are sufficient
# for the reports of sanitizers. More debug information would need a third of the compiler's time.
# Most of the remaining time is for headers, so a unity build is used: it reads a header once for
# many files.
build() {
  local dir=$1 needed_by=$2 linker=()
  shift 2
  # lld links 20 targets in 1.4 s of CPU time, GNU ld in 3.6 s. If the caller has set a linker, it
  # is used instead.
  if [ -z "${CC_LD:-}${CXX_LD:-}" ] && command -v ld.lld >/dev/null; then linker=(CC_LD=lld CXX_LD=lld); fi
  echo "== build $(basename "$dir") (${SECONDS}s)"
  if [ -f "$dir/build.ninja" ]; then
    ninja -C "$dir" build.ninja  # a change of a meson.build may have added targets
  else
    env "${linker[@]}" meson setup "$dir" "$root" -Dcpp_args=-g1 -Dwerror=true --unity on -Dunity_size=40 "$@"
  fi >"$dir.log" 2>&1 || { tail -20 "$dir.log"; return 1; }
  local wanted=()
  # shellcheck disable=SC2086
  [ "$needed_by" = all ] || mapfile -t wanted < <(targets "$dir" $needed_by)
  ninja -C "$dir" "${wanted[@]}" >"$dir.log" 2>&1 ||
    { grep -A12 -E 'FAILED|error:' "$dir.log" | head -60; return 1; }
}

# Builds with clang, because it needs half of gcc's time for code with many checks. Optimization is
# off by default, because it would take minutes. Only code that tests run for a long time is
# optimized.
build_sanitized() {
  local cache
  # ccache must be named, because meson does not use it by itself if a compiler is named.
  cache=$(command -v ccache)
  CC="$cache clang" CXX="$cache clang++" build "$root/build-asan" "$sanitized" -Db_sanitize=address,undefined -Db_lundef=false -Doptimization=0 \
    -Dbenchmarks=disabled
}
# Starts the sanitized build in the background with idle priority. It uses the processor time that
# is free during the tests of the first build, which mostly wait.
start_sanitized() {
  build_sanitized &
  sanitized_job=$!
  chrt --idle -p 0 "$sanitized_job"
}
# hurry PID: gives a process and its children normal priority again. If this is not permitted, they
# continue with idle priority.
hurry() {
  local child
  chrt --other -p 0 "$1" 2>/dev/null
  for child in $(pgrep -P "$1"); do hurry "$child"; done
}
# Waits for the sanitized build if it was started, or else runs it. Succeeds if the build succeeded.
sanitized_ready() {
  if [ -z "$sanitized_result" ]; then
    if [ -n "$sanitized_job" ]; then
      hurry "$sanitized_job"
      wait "$sanitized_job"
    else
      build_sanitized
    fi
    sanitized_result=$?
  fi
  return "$sanitized_result"
}

# Filters meson's output of a suite. Removes the lines with counts, because the counts are printed
# at the end.
shorten() { grep -vE '^$|^ninja|Full log|^(Ok|Expected Fail|Fail|Unexpected Pass|Skipped|Timeout):'; }

# results DIR NAME: prints the logs of meson that are called NAME or NAME-WRAPPER. No log has the
# name that meson uses by default, so `meson test` can run by hand at the same time.
results() { cat "$1/meson-logs/$2".json "$1/meson-logs/$2"-*.json 2>/dev/null; }
forget() { rm -f "$1/meson-logs/$2".json "$1/meson-logs/$2"-*.json; }

# tally LOG: adds the results in a log to the totals. Keeps the last lines of the output of each
# failed test.
tally() {
  local counts ok bad
  counts=$(jq -s -r '[(map(select(.result == "OK" or .result == "EXPECTEDFAIL")) | length),
      (map(select(.result != "OK" and .result != "EXPECTEDFAIL" and .result != "SKIP")) | length)]
      | @tsv' "$1")
  read -r ok bad <<<"$counts"
  passed=$((passed + ok))
  failed=$((failed + bad))
  failures+=$(jq -r 'select(.result | IN("OK", "EXPECTEDFAIL", "SKIP") | not)
      | "\n== \(.result): \(.name)", (((.stdout // "") + (.stderr // "")) / "\n" | .[-20:][] | "  " + .)' "$1")
}

# settle DIR SUITE NAME: adds the results of SUITE in the log NAME of meson to the totals.
settle() {
  local log=$1/meson-logs/settled.json
  # A test is called "gst-lidar:SUITE+SUITE / TEST" in the log.
  results "$1" "$3" |
    jq -c --arg suite "$2" 'select(.name | sub("^[^:]*:"; "") | sub(" / .*"; "") | split("+") | index($suite))' >"$log"
  [ -s "$log" ] || { echo "meson left no results of $2"; failed=$((failed + 1)); return; }
  tally "$log"
}

# run DIR SUITES [meson options]: runs the tests of several suites together, and adds their results
# to the totals.
run() {
  local dir=$1 suites suite chosen=()
  read -ra suites <<<"$2"
  shift 2
  for suite in "${suites[@]}"; do chosen+=(--suite "$suite"); done
  echo "== $(basename "$dir"): ${suites[*]} (${SECONDS}s)"
  forget "$dir" suites
  meson test -C "$dir" --no-rebuild "${patient[@]}" "${chosen[@]}" --logbase suites --print-errorlogs "$@" 2>&1 | shorten
  # An exit code of 128 or more means that a signal killed meson. Results of tests may then be
  # missing.
  [ "${PIPESTATUS[0]}" -lt 128 ] || failed=$((failed + 1))
  [ "${suites[*]}" != pipelines ] || return 0
  for suite in "${suites[@]}"; do settle "$dir" "$suite" suites; done
}

# Runs the suites `pipelines` and `beside` at the same time. Tests of pipelines stream in real time,
# so at most one of them runs per core. Tests of the suite `beside` run with lower priority, because
# they mostly wait or do not depend on time.
run_pipelines() {
  local dir=$1
  forget "$dir" beside
  nice -n 10 meson test -C "$dir" --no-rebuild "${patient[@]}" --suite beside --logbase beside --print-errorlogs \
    >"$dir/beside.log" 2>&1 &
  local beside=$!
  run "$dir" pipelines
  wait "$beside"
  [ $? -lt 128 ] || failed=$((failed + 1))
  shorten <"$dir/beside.log"
  settle "$dir" pipelines suites
  settle "$dir" beside beside
}

# Runs the suites core, fuzz and elements at the same time. Tests of elements stream in real time
# and mostly wait. The other tests have idle priority, and use the processor time that is free.
run_sanitized() {
  local dir=$1 rest
  forget "$dir" rest
  meson test -C "$dir" --no-rebuild "${patient[@]}" --suite core --suite fuzz --logbase rest --print-errorlogs \
    "${without_dear[@]}" >"$dir/rest.log" 2>&1 &
  rest=$!
  chrt --idle -p 0 "$rest"
  run "$dir" elements "${without_dear[@]}" "${waiting[@]}"
  hurry "$rest"
  wait "$rest"
  [ $? -lt 128 ] || failed=$((failed + 1))
  shorten <"$dir/rest.log"
  settle "$dir" core rest
  settle "$dir" fuzz rest
}

# Counts the result of a step that is not a test of meson.
count() { if [ "$1" = 0 ]; then passed=$((passed + 1)); else failed=$((failed + 1)); fi; }

[ "$install" = no ] || "$here/install.sh" || exit 1
case $install,${suites[*]} in
  yes,browser | yes,peers | yes,viewers) "$here/install.sh" "$here/system/${suites[*]}/packages.txt" || exit 1 ;;
esac
if [ "$install" = yes ] && [ "${suites[*]}" = browser ]; then
  for folder in "$root/ext/web/page" "$here/system/browser"; do
    # Newer versions of npm refuse a lock file that lacks the optional packages of other platforms.
    # `npm install` accepts the file, and installs the versions that are in it.
    (cd "$folder" && { npm ci --silent --no-audit --no-fund || npm install --no-save --silent --no-audit --no-fund; }) ||
      { echo "npm cannot install what $folder/package.json asks for"; exit 1; }
  done
fi

needed_by=all
# The suites elements and fuzz take a third of the time to compile and half of the time to test. So
# a run of all suites runs them only under the sanitizers. The exception is the suite `plain`, which
# cannot run under sanitizers.
if [ "$sanitize" = yes ] && [ ${#suites[@]} -gt 0 ]; then
  suites=(lint "core plain" pipelines bench)
  needed_by="product ${suites[*]} beside"
fi
if [ ${#suites[@]} -gt 0 ]; then
  if build "$root/build" "$needed_by"; then
    [ "$sanitize" = no ] || start_sanitized
    for suite in "${suites[@]}"; do
      case $suite in
        pipelines) run_pipelines "$root/build" ;;
        bench | faults | peers | browser | viewers) run "$root/build" "$suite" --num-processes 1 ;;
        elements) run "$root/build" elements "${waiting[@]}" ;;
        *) run "$root/build" "$suite" ;;
      esac
    done
  else
    count 1
  fi
fi

if [ "$tidy" = yes ]; then
  echo "== clang-tidy (${SECONDS}s)"
  "$here/tidy.sh"
  count $?
fi

if [ "$sanitize" = yes ]; then
  if sanitized_ready; then
    run_sanitized "$root/build-asan"
  else
    count 1
  fi
fi

if [ "$tsan" = yes ]; then
  if build "$root/build-tsan" "core elements" -Db_sanitize=thread -Db_lundef=false -Doptimization=1 \
    -Dbenchmarks=disabled -Dtools=disabled -Dwerror=false; then
    # Runs a few tests first, so that GStreamer's registry exists. Otherwise a test that creates the
    # registry would report data races in plugins of other projects.
    meson test -C "$root/build-tsan" --no-rebuild common >/dev/null 2>&1
    for suite in core elements; do
      # The time limits are much longer, because ThreadSanitizer makes a coder twenty times slower.
      run "$root/build-tsan" "$suite" "${without_dear[@]}" --timeout-multiplier 200
    done
  else
    count 1
  fi
fi

[ -z "$failures" ] || echo "$failures"
echo "== $((SECONDS - started)) s"
echo "$passed passed, $failed failed"
[ "$failed" = 0 ] && [ "$passed" -gt 0 ]
