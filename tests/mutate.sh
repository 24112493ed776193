#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Applies patches with one small bug each, and prints for each bug whether the tests notice it.
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(dirname "$here")

usage() {
  cat <<EOF
Usage: tests/mutate.sh [--quick | --check] [--folder DIR] [NAME...]

Each tests/mutants/NAME.patch is a bug of a line or two. tests/plant.py finds the code it changes,
wherever that stands, in a copy of the tree; what changed is built, and the suites core and elements
run until a test fails. The line "Tests:" of a
patch names the tests that are meant to notice it; they run first.

  --quick         run only the tests that the patches name
  --check         build and run nothing: say which patches do not fit the code any more
  --folder DIR    where the copy is built (build-mutants); kept, so that the next time is faster

A name may be a pattern, as in 'rtp-*'. The exit code is 0 where every bug was noticed.
EOF
}

quick=no
check=no
folder=$root/build-mutants
names=()
while [ $# -gt 0 ]; do
  case $1 in
    --quick) quick=yes ;;
    --check) check=yes ;;
    --folder) [ $# -ge 2 ] || { usage >&2; exit 2; }; folder=$2; shift ;;
    -h | --help) usage; exit 0 ;;
    -*) echo "Unknown option '$1'." >&2; usage >&2; exit 2 ;;
    *) names+=("$1") ;;
  esac
  shift
done

patches=()
for name in "${names[@]-*}"; do
  for patch in "$here"/mutants/${name:-*}.patch; do
    [ -f "$patch" ] || { echo "No patch is called '$name'." >&2; exit 2; }
    patches+=("$patch")
  done
done

if [ "$check" = yes ]; then
  "$here/plant.py" --check "$root" "${patches[@]}"
  exit
fi

mkdir -p "$folder" || exit 2
folder=$(cd "$folder" && pwd)
tree=$folder/tree
# The build folder has the same place in the tree as in a usual build, so that a compiler cache
# finds what it has compiled there.
build=$tree/build
log=$folder/log

# Copies the tree. Files that have not changed keep their modification times, so that only changed
# files are built again.
copy_tree() {
  mkdir -p "$tree"
  git -C "$root" ls-files --cached --others --exclude-standard | sort >"$folder/files"
  (cd "$tree" && find . -path ./build -prune -o -type f -print | sed 's|^\./||' | sort | comm -13 "$folder/files" - | xargs -r -d '\n' rm)
  while IFS= read -r file; do
    cmp -s "$root/$file" "$tree/$file" && continue
    mkdir -p "$(dirname "$tree/$file")" && cp -p "$root/$file" "$tree/$file" && touch "$tree/$file" || return 1
  done <"$folder/files"
}

# Restores the files that the last patch changed.
restore() {
  local file
  while IFS= read -r file; do
    cp "$root/$file" "$tree/$file" || return 1
  done <"$folder/planted"
}

compile() {
  [ -f "$build/build.ninja" ] || meson setup "$build" "$tree" -Dcpp_args=-g1 -Dwerror=false -Dbenchmarks=disabled >"$log" 2>&1 ||
    { tail -20 "$log" >&2; exit 2; }
  ninja -C "$build" "$@" >"$log" 2>&1
}

# Prints the name of a file with an introspection of the build. The build is introspected only once,
# because no patch changes a meson.build and so the targets of a test remain the same.
introspect() {
  [ "$folder/$1.json" -nt "$build/build.ninja" ] || meson introspect "$build" "--$1" >"$folder/$1.json"
  echo "$folder/$1.json"
}

# Prints the targets that the named tests need, in the form that ninja expects. Without a name,
# prints the targets that the suites core and elements need.
targets() {
  jq -rn --arg dir "$build/" --arg names "$*" \
    --slurpfile tests "$(introspect tests)" --slurpfile all "$(introspect targets)" '
    ($names | split(" ")) as $wanted
    | [$tests[0][] | select((.name | IN($wanted[]))
        or ($names == "" and any(.suite[]; sub(".*:"; "") | IN("core", "elements")))) | .depends[]] as $needed
    | $all[0][] | select(.id | IN($needed[])) | .filename[] | ltrimstr($dir)'
}

# Runs the tests until one of them fails, and prints the name of that test. Fails if no test fails.
first_failure() {
  meson test -C "$build" --no-rebuild --maxfail 1 "$@" >"$log" 2>&1 && return 1
  jq -r 'select(.result | IN("OK", "SKIP", "EXPECTEDFAIL") | not) | .name | sub(".*/ "; "")' \
    "$build/meson-logs/testlog.json" | head -1
}

# Prints the result of one patch: "noticed by TEST", "NOT NOTICED", or the reason why the patch
# could not be tested.
try_patch() {
  local patch=$1 tests failed wanted
  tests=$(sed -n 's/^Tests: //p;/^---/q' "$patch")
  "$here/plant.py" "$tree" "$patch" >"$folder/planted" 2>/dev/null || { echo "DOES NOT FIT"; return; }
  if [ -n "$tests" ]; then
    # shellcheck disable=SC2086
    mapfile -t wanted < <(targets $tests)
    # shellcheck disable=SC2086
    if [ ${#wanted[@]} = 0 ]; then echo "ITS TESTS ARE NOT BUILT"; return
    elif ! compile "${wanted[@]}"; then echo "DOES NOT BUILD"; return
    elif failed=$(first_failure $tests); then echo "noticed by $failed"; return; fi
  fi
  [ "$quick" = no ] || { echo "NOT NOTICED"; return; }
  mapfile -t wanted < <(targets)
  if ! compile "${wanted[@]}"; then echo "DOES NOT BUILD"
  elif failed=$(first_failure --suite core --suite elements); then echo "noticed by $failed"
  else echo "NOT NOTICED"; fi
}

copy_tree || exit 2
if [ "$quick" = no ]; then
  compile || { grep -A12 -E 'FAILED|error:' "$log" | head -40 >&2; exit 2; }
  if failed=$(first_failure --suite core --suite elements); then
    echo "Without any bug, $failed fails: nothing can be said." >&2
    exit 2
  fi
else
  compile build.ninja || { tail -20 "$log" >&2; exit 2; }
fi

noticed=0
for patch in "${patches[@]}"; do
  outcome=$(try_patch "$patch")
  restore || exit 2
  printf '%-36s %s\n' "$(basename "$patch" .patch)" "$outcome"
  case $outcome in noticed*) noticed=$((noticed + 1)) ;; esac
done
echo "$noticed of ${#patches[@]} noticed"
[ "$noticed" = ${#patches[@]} ]
