# SPDX-License-Identifier: LGPL-2.1-or-later
# Sourced by the experiments: options, where things are, and how results are written.
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
letter=$(basename "$0")
letter=${letter%%_*}

usage() {
  cat <<TEXT
Usage: tests/experiments/$(basename "$0") [options]

  --quick        500 m instead of 10 km, one run instead of three
  --only LIST    run.sh: letters of the experiments, as in "abg"
  --trace FILE   capacity from lines of 'time_s rate_mbps', over and over, instead of a generated
                 drive with handover gaps
  --rate MBPS    mean of the generated drive (default 2)
  --capture FILE an Ouster capture for experiment b, with its metadata beside it (.json)
  --seed N       of the world and of the generated drive (default 1)
  --output DIR   where tables, plots and verdicts go (default experiments-output)

Needs a build: meson setup build && ninja -C build, or BUILD_DIR.
TEXT
}
fail() { echo "$(basename "$0"): $*" >&2; exit 2; }

quick=no only=abcdefghi trace='' rate=2 capture='' seed=1 output=experiments-output
options=("$@")
while [ $# -gt 0 ]; do
  case $1 in
    --quick) quick=yes ;;
    --only | --trace | --rate | --capture | --seed | --output)
      [ $# -ge 2 ] || fail "$1 wants a value"
      declare "${1#--}=$2"
      shift ;;
    -h | --help) usage; exit 0 ;;
    *) fail "there is no option $1" ;;
  esac
  shift
done
[ -z "$trace" ] || [ -f "$trace" ] || fail "no file $trace"
[ -z "$capture" ] || [ -f "$capture" ] || fail "no file $capture"
[[ $seed =~ ^[0-9]+$ && $rate =~ ^[0-9.]+$ ]] || fail "--seed and --rate want numbers"

. "$root/pipelines/environment.sh"
tools=$build/src/tools
speed=12
if [ $quick = yes ]; then length=500 runs=1; else length=10000 runs=3; fi
seconds=$((length / speed + 1))
scans=$((seconds * 10))
mkdir -p "$output"
csv=$output/$letter.csv
png=$output/$letter.png

# verdict TEXT: the one line that an experiment ends with.
verdict() {
  echo "$letter: $*" | tee "$output/$letter.txt"
}
# slam SOURCE [options]: one JSON object on a line.
slam() { "$tools/lidar-eval" slam --json --speed $speed --seed "$seed" "$@" 2>/dev/null | jq -c .; }
# plot: gnuplot commands on standard input; the picture is $png.
plot() {
  { echo "set terminal pngcairo size 1000,${plot_height:-460} font 'sans,10'"
    echo "set output '$png'; set datafile separator ','; set grid; set key outside right top"
    cat; } | gnuplot 2>"$output/$letter.log" || echo "$letter: no plot, see $output/$letter.log" >&2
}
