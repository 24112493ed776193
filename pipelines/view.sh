#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Looks at point clouds: pictures of every view, or a window.
set -euo pipefail
source "$(dirname "$0")/options.sh"

usage() {
  cat <<'EOF'
Usage: pipelines/view.sh [options] [SOURCE]

Writes top.png, perspective.png and range.png of one scan, or shows the clouds in a window.

  SOURCE        what gst-launch-1.0 understands as a source of clouds
                (default "lidartestsrc model=os1-128"), for example
                "ouster_src location=drive.pcap metadata=drive.json"
  --scan N      the scan to draw, from 1 (default 5)
  --output DIR  where the pictures go (default view-output)
  --window VIEW show top, perspective or range in a window, until Ctrl-C
EOF
}

source="lidartestsrc model=os1-128"
scan=5
output=view-output
window=
while [ $# -gt 0 ]; do
  case $1 in
    --scan) count "$@"; scan=$2; shift ;;
    --output) text "$@"; output=$2; shift ;;
    --window) text "$@"; window=$2; shift ;;
    -h | --help) usage; exit 0 ;;
    -*) wrong "there is no option $1" ;;
    *) source=$1 ;;
  esac
  shift
done
. "$(dirname "$0")/environment.sh"

# SOURCE is not quoted below, because it is a list of words.
if [ -n "$window" ]; then
  case $source in lidartestsrc* | ouster_src*) source="$source is-live=true" ;; esac
  # shellcheck disable=SC2086
  exec gst-launch-1.0 -e $source ! queue ! pointcloudview view="$window" ! videoconvert ! autovideosink
fi
mkdir -p "$output"
pictures=()
for view in top perspective range; do
  pictures+=(views. ! queue ! pointcloudview "view=$view" ! pngenc snapshot=false ! multifilesink "location=$output/$view.png")
done
# shellcheck disable=SC2086
(launch $source ! scanassembler ! identity eos-after="$((scan + 1))" ! tee name=views "${pictures[@]}")
ls "$output"/top.png "$output"/perspective.png "$output"/range.png
