#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Measures the figures of docs/results/ecosystem.md, and prints them as the tables of that page.
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(dirname "$(dirname "$here")")

usage() {
  cat <<EOF
Usage: tests/benchmarks/ecosystem.sh [--build DIR] [--clouds N] [--only ros2|web]

  --build DIR   a build tree (default: build)
  --clouds N    clouds of each row of the tables of ROS 2 (default 50)
  --only PART   leave the other part out

Takes about eight minutes and wants an idle machine. The rows with a small receive buffer need root;
the part of Foxglove needs Chromium and npm's packages, which tests/run.sh --suite browser installs.
EOF
}

build=$root/build
clouds=50
only=all
while [ $# -gt 0 ]; do
  case $1 in
    --build | --clouds | --only)
      [ $# -ge 2 ] || { usage >&2; exit 2; }
      declare "${1#--}=$2"
      shift ;;
    -h | --help) usage; exit 0 ;;
    *) echo "Unknown option '$1'." >&2; usage >&2; exit 2 ;;
  esac
  shift
done
case $only in all | ros2 | web) ;; *) usage >&2; exit 2 ;; esac
[[ $clouds =~ ^[1-9][0-9]*$ ]] || { echo "--clouds wants a number" >&2; exit 2; }
[ -f "$build/build.ninja" ] || { echo "There is no build tree at $build." >&2; exit 2; }
build=$(cd "$build" && pwd)
bench=$build/tests/elements/ros2/ros2-bench
mapfile -t plugins < <(meson introspect "$build" --targets | jq -r --arg dir "$build/" '.[].filename[] | select(test("/libgst[^/]*[.]so$")) | ltrimstr($dir)')
ninja -C "$build" "${plugins[@]}" "${bench#"$build/"}" >/dev/null 2>&1 || { echo "The build fails." >&2; exit 1; }

# Uses the plugins of the build tree. DDS uses the loopback interface only.
export GST_PLUGIN_PATH_1_0 GST_REGISTRY=$build/benchmark-registry.bin
export CYCLONEDDS_URI='<General><Interfaces><NetworkInterface name="lo" multicast="true"/></Interfaces></General>'
GST_PLUGIN_PATH_1_0=$(printf "$build/%s\n" "${plugins[@]%/*}" | sort -u | paste -sd:)

# measure ELEMENT PEER QOS WIDTH: runs ros2-bench, and prints its figures as a row of a table.
measure() {
  "$bench" "$1" "$2" "$3" "$4" "$clouds" 2>/dev/null | awk -v element="ros2$1" -v peer="$2" -v qos="$3" '
    { who = $1; sub(":", "", who); cpu[who] = $2 " %" }
    match($0, /[0-9]+ of [0-9]+ clouds, .*/) {
      split(substr($0, RSTART), part, /, |; /)
      came = part[1]; sub(" clouds", "", came)
      bad = part[2]; sub(" not intact", "", bad)
      mean = part[3]; sub("latency ", "", mean)
      most = part[4]; sub("at most ", "", most)
    }
    END {
      if (peer == "fast") peer = "Fast DDS"
      else peer = element == "ros2src" ? "`ros2sink`" : "`ros2src`"
      if (came == "") { came = "none"; bad = 0; mean = most = "–" }
      if (bad != 0) came = came ", " bad " damaged"
      if (qos != "reliable") peer = peer ", " qos
      printf "| `%s` | %s | %s | %s | %s | %s | %s |\n", element, peer, came, cpu[element], cpu["peer"], mean, most
    }'
}

# table WIDTH ROW...: prints a table of clouds with WIDTH columns. Each ROW has the other arguments
# of measure.
table() {
  local width=$1 row
  shift
  echo "| element | peer | clouds | element's CPU | peer's CPU | latency, mean | latency, max |"
  echo "|---|---|---|---|---|---|---|"
  for row in "$@"; do
    # shellcheck disable=SC2086
    measure $row "$width"
  done
}

to_source=("src fast reliable" "src fast sensor-data" "src cyclone reliable" "src cyclone sensor-data")

measure_ros2() {
  printf '\nOS1-128 1024x10: %s points, %s bytes a cloud.\n\n' $((1024 * 128)) $((1024 * 128 * 24))
  table 1024 "src fast reliable" "src cyclone reliable" "sink fast reliable"
}

# Measures with the default receive buffer of Linux, which has 208 KiB.
measure_small_buffer() {
  local setting=/proc/sys/net/core/rmem_max granted
  granted=$(cat "$setting")
  { echo 212992 >"$setting"; } 2>/dev/null || { printf '\nOnly root can measure with a receive buffer of 208 KiB.\n'; return; }
  # shellcheck disable=SC2064
  trap "echo $granted >$setting" EXIT
  printf '\nWith a receive buffer of 208 KiB, OS1-128 1024x10.\n\n'
  table 1024 "${to_source[@]}"
  echo "$granted" >"$setting"
  trap - EXIT
}

echo "$(nproc) cores, $(sed -n 's/^model name\s*: //p' /proc/cpuinfo | head -1), Linux $(uname -r)," \
  "load before: $(cut -d' ' -f1 /proc/loadavg), net.core.rmem_max: $(cat /proc/sys/net/core/rmem_max)"
if [ "$only" != web ]; then
  measure_ros2
  measure_small_buffer
fi
if [ "$only" != ros2 ]; then
  if [ -d "$root/tests/system/browser/node_modules" ] && [ -x "${CHROMIUM:-/usr/bin/chromium}" ]; then
    node "$root/tests/system/browser/measure.mjs"
  else
    printf '\nfoxglovesink is left out: tests/run.sh --suite browser installs what it needs.\n'
  fi
fi
printf '\nLoad after: %s\n' "$(cut -d' ' -f1 /proc/loadavg)"
