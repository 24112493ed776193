# SPDX-License-Identifier: LGPL-2.1-or-later
# To be sourced by the experiments. Parses the options, sets the paths, and defines functions that
# write results.
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
letter=$(basename "$0")
letter=${letter%%_*}

usage() {
  cat <<TEXT
Usage: tests/experiments/$(basename "$0") [options]

  --quick        500 m and one run
  --length M     of each drive (default 10000; b and h take 5000 of them at most)
  --runs N       over the network, with seeds from --seed on (default 3)
  --parallel N   of these runs side by side (default 1): each takes 0.6 of a core for as long as
                 the drive lasts
  --only LIST    run.sh: letters of the experiments, as in "abg"
  --trace FILE   capacity from lines of 'time_s rate_mbps', over and over, instead of a generated
                 drive with handover gaps; may come again: c drives over each, the others over the
                 first
  --rate MBPS    mean of the generated drive (default 2)
  --capture FILE an Ouster capture for experiment b, with its metadata beside it (.json)
  --seed N       of the world and of the generated drive (default 1)
  --output DIR   where tables, plots and verdicts go (default experiments-output)

Needs a build: meson setup build && ninja -C build, or BUILD_DIR.
TEXT
}
fail() { echo "$(basename "$0"): $*" >&2; exit 2; }

quick=no length=10000 runs=3 parallel=1 only=abcdefghi rate=2 capture='' seed=1 output=experiments-output
traces=()
options=("$@")
while [ $# -gt 0 ]; do
  case $1 in
    --quick) quick=yes length=500 runs=1 ;;
    --length | --runs | --parallel | --only | --trace | --rate | --capture | --seed | --output)
      [ $# -ge 2 ] || fail "$1 wants a value"
      if [ "$1" = --trace ]; then traces+=("$2"); else declare "${1#--}=$2"; fi
      shift ;;
    -h | --help) usage; exit 0 ;;
    *) fail "there is no option $1" ;;
  esac
  shift
done
for trace in "${traces[@]}"; do
  [ -f "$trace" ] || fail "no file $trace"
done
[ -z "$capture" ] || [ -f "$capture" ] || fail "no file $capture"
[[ $seed =~ ^[0-9]+$ && $rate =~ ^[0-9.]+$ ]] || fail "--seed and --rate want numbers"
for number in "$length" "$runs" "$parallel"; do
  [[ $number =~ ^[1-9][0-9]*$ ]] || fail "--length, --runs and --parallel want whole numbers above zero"
done

. "$root/pipelines/environment.sh"
tools=$build/src/tools
speed=12
# The vehicle drives slower in the bends of the town, so a drive there is a tenth shorter than the
# length.
seconds=$((length / speed + 1))
scans=$((seconds * 10))
offline_scans=$((scans < 4200 ? scans : 4200)) # 4200 scans are five kilometres
mkdir -p "$output"
csv=$output/$letter.csv
png=$output/$letter.png

# verdict TEXT: prints the result of the experiment as a line, and writes it to a file.
verdict() {
  echo "$letter: $*" | tee "$output/$letter.txt"
}
# slam SOURCE [options]: runs SLAM over a source. Prints its results as a JSON object in one line.
slam() { "$tools/lidar-eval" slam --json --speed $speed --seed "$seed" "$@" 2>/dev/null | jq -c .; }
# plot: reads gnuplot commands from standard input, and draws the picture $png.
plot() {
  { echo "set terminal pngcairo size ${plot_width:-1000},${plot_height:-460} font 'sans,10'"
    echo "set output '$png'; set datafile separator ','; set grid; set key outside right top"
    cat; } | gnuplot 2>"$output/$letter.log" || echo "$letter: no plot, see $output/$letter.log" >&2
}
