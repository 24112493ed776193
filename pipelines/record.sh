#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Records scans as files, one a scan.
set -euo pipefail
source "$(dirname "$0")/options.sh"

usage() {
  cat <<'EOF'
Usage: pipelines/record.sh [options] [SOURCE]

Writes scans as DIR/scan000000.pcd and so on. From the synthetic sensor it writes the exact
trajectory, too, as DIR/trajectory.tum.

  SOURCE        what gst-launch-1.0 understands as a source of clouds
                (default "lidartestsrc model=os1-128"), for example "ouster_src hostname=os1.local"
  --scans N     how many (default 10)
  --format F    pcd, pcd-text, ply, ply-text or bin: the bytes of the buffer (default pcd)
  --output DIR  where the files go (default record-output)
EOF
}

source="lidartestsrc model=os1-128"
scans=10
format=pcd
output=record-output
while [ $# -gt 0 ]; do
  case $1 in
    --scans) count "$@"; scans=$2; shift ;;
    --format) text "$@"; format=$2; shift ;;
    --output) text "$@"; output=$2; shift ;;
    -h | --help) usage; exit 0 ;;
    -*) wrong "there is no option $1" ;;
    *) source=$1 ;;
  esac
  shift
done
. "$(dirname "$0")/environment.sh"

case $format in
  pcd) encoder="pcdenc" ;;
  pcd-text) encoder="pcdenc binary=false" ;;
  ply) encoder="plyenc" ;;
  ply-text) encoder="plyenc binary=false" ;;
  bin) encoder="identity" ;;
  *) wrong "there is no format $format" ;;
esac
mkdir -p "$output"
read -ra words <<<"$source"
case $source in lidartestsrc*) words+=("trajectory-location=$output/trajectory.tum") ;; esac
# shellcheck disable=SC2086
gst-launch-1.0 -q -e "${words[@]}" ! scanassembler ! identity eos-after="$((scans + 1))" \
  ! $encoder ! multifilesink location="$output/scan%06d.${format%-text}"
ls "$output"
