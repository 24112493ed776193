#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Runs every test, check and measurement of the tree, and prints a table of these steps at the end.
# Takes hours.
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(dirname "$here")

# Each step consists of a name, the requirements beyond tests/packages.txt, and a command that runs
# in the root of the tree. The steps run one after the other. Only the soak runs beside the others,
# because it mostly waits.
steps=(
  "soak|root|env BUILD_DIR=build-soak tests/system/soak/run.sh --minutes SOAK"
  "run|-|tests/run.sh"
  "faults|root|tests/run.sh --no-install --suite faults"
  "peers|npm|tests/run.sh --no-install --suite peers"
  "browser|npm|tests/run.sh --suite browser"
  "viewers|nginx, Caddy|tests/run.sh --suite viewers"
  "tsan|-|tests/run.sh --no-install --suite lint --tsan"
  "tidy|-|tests/tidy.sh"
  "fuzz|-|tests/fuzz/run.sh --minutes MINUTES --jobs 2"
  "adversary|-|tests/system/adversary/run.sh --minutes MINUTES"
  "hardship|root|tests/system/hardship/run.sh"
  "leaks|-|tests/leaks.sh"
  "memory|-|tests/system/soak/memory.sh MINUTES"
  "interop|root, the reference|tests/system/interop/reference.sh"
  "experiments|-|tests/experiments/run.sh --quick"
  "mutants|-|tests/mutate.sh --quick"
  "bookworm|root, mmdebstrap|packaging/build-deb.sh --release bookworm"
  "trixie|root, mmdebstrap|packaging/build-deb.sh --release trixie"
  "tests-trixie|root, mmdebstrap|tests/other-releases.sh trixie"
  "tests-sid|root, mmdebstrap|tests/other-releases.sh sid"
  "tests-arm64|root, mmdebstrap|tests/other-releases.sh arm64"
)

usage() {
  cat <<EOF
Usage: tests/all.sh [options]

  --only LIST    steps to run, as in "run,fuzz"
  --skip LIST    steps to leave out
  --minutes N    for each fuzz target, the adversary and memory (default 2)
  --soak N       minutes of soak (default 120)
  --output DIR   a log for each step (default: build-all)
  --list         print the steps, what they need and their commands

Steps: $(printf '%s\n' "${steps[@]%%|*}" | paste -sd' ')
The exit code is 0 where every step passed or was skipped for what it needs.
EOF
}
fail() { echo "tests/all.sh: $*" >&2; exit 2; }

only=
skip=
minutes=2
soak=120
output=$root/build-all
while [ $# -gt 0 ]; do
  case $1 in
    --only | --skip | --minutes | --soak | --output)
      [ $# -ge 2 ] || fail "$1 wants a value"
      declare "${1#--}=$2"
      shift ;;
    --list) printf '%s\n' "${steps[@]}" | awk -F'|' '{ printf "%-13s %-21s %s\n", $1, $2, $3 }'; exit 0 ;;
    -h | --help) usage; exit 0 ;;
    *) fail "there is no option $1" ;;
  esac
  shift
done
for name in minutes soak; do
  [[ ${!name} =~ ^[1-9][0-9]*$ ]] || fail "--$name wants a whole number above zero, not \"${!name}\""
done
for name in ${only//,/ } ${skip//,/ }; do
  printf '%s\n' "${steps[@]%%|*}" | grep -qxF -- "$name" || fail "there is no step $name"
done
mkdir -p "$output" || exit 2
output=$(cd "$output" && pwd)

# wanted NAME: succeeds if --only and --skip allow the step NAME.
wanted() { [[ (-z $only || ,$only, == *,$1,*) && ,$skip, != *,$1,* ]]; }

# lacks NEEDS: prints the first requirement of the list NEEDS that this machine does not fulfil.
lacks() {
  local need
  while read -r need; do
    case $need in
      root) [ "$(id -u)" = 0 ] || echo "root" ;;
      npm | mmdebstrap) command -v "$need" >/dev/null || echo "$need" ;;
      "the reference") [ -n "${SCREAM_REFERENCE:-}" ] || echo "SCREAM_REFERENCE" ;;
    esac
  done < <(tr ',' '\n' <<<"$1" | sed 's/^ //') | head -1
}

rows=$output/table
printf '%-13s %-8s %8s  %s\n' step result seconds 'last line' >"$rows"
# row STEP RESULT SECONDS LAST_LINE: prints a row of the table, and adds it to the file.
row() { printf '%-13s %-8s %8s  %s\n' "$@" | tee -a "$rows"; }
# take NAME COMMAND: runs a step, and adds a row with its result to the table.
take() {
  local began=$SECONDS result=ok
  # shellcheck disable=SC2086
  (cd "$root" && exec $(sed "s/MINUTES/$minutes/; s/SOAK/$soak/" <<<"$2")) >"$output/$1.log" 2>&1 </dev/null || result=FAILED
  row "$1" "$result" $((SECONDS - began)) "$(grep -v '^[[:space:]]*$' "$output/$1.log" | tail -1 | cut -c -100)"
}
for step in "${steps[@]}"; do
  IFS='|' read -r name needs command <<<"$step"
  wanted "$name" || continue
  lacking=$(lacks "$needs")
  if [ -n "$lacking" ]; then
    row "$name" skipped 0 "needs $lacking"
  elif [ "$name" = soak ]; then
    # Jobs ignore Ctrl-C, so the script has to end the soak when it exits. For that the soak runs in
    # a process group of its own.
    set -m
    take "$name" "$command" &
    soak_group=$!
    set +m
    trap '[ -z "$soak_group" ] || kill -- -"$soak_group" 2>/dev/null' EXIT
    trap 'exit 130' INT TERM
  else
    take "$name" "$command"
  fi
done
wait
soak_group=

echo
cat "$rows"
failed=$(grep -c '^[^ ]* *FAILED ' "$rows")
echo "logs: $output; $failed of $(($(wc -l <"$rows") - 1)) failed"
[ "$failed" = 0 ]
