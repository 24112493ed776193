#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Records a source of clouds: MCAP files of slices or clouds, or one file a scan.
set -euo pipefail
source "$(dirname "$0")/options.sh"

usage() {
  cat <<'USAGE'
Usage: pipelines/record.sh [options] [SOURCE]

Writes DIR/rec-00000.mcap and so on, which pipelines/play.sh plays, or scans as files,
DIR/scan000000.pcd and so on. From the synthetic sensor it writes the exact trajectory, too, as
DIR/trajectory.tum.

  SOURCE          what gst-launch-1.0 understands as a source of clouds
                  (default "lidartestsrc model=os1-128"), for example "ouster_src hostname=os1.local"
  --format F      slices: MCAP of compressed slices; clouds: MCAP of whole scans, for ROS 2 and
                  Foxglove; pcd, pcd-text, ply, ply-text, or bin: the bytes of the buffer (default slices;
                  with --scans pcd)
  --scans N       with files, how many (default 10)
  --seconds N     with MCAP, for how long (default 10)
  --encoder E     with slices, the encoder (default "lidarenc max-error=0.02")
  --piece N       with MCAP, begin a file every N seconds (default 300)
  --output DIR    where the files go (default record-output)
USAGE
}

source="lidartestsrc model=os1-128"
scans=10
seconds=10
piece=300
encoder="lidarenc max-error=0.02"
format=
output=record-output
while [ $# -gt 0 ]; do
  case $1 in
    --scans) count "$@"; scans=$2; format=${format:-pcd}; shift ;;
    --seconds) number "$@"; seconds=$2; shift ;;
    --piece) count "$@"; piece=$2; shift ;;
    --encoder) text "$@"; encoder=$2; shift ;;
    --format) text "$@"; format=$2; shift ;;
    --output) text "$@"; output=$2; shift ;;
    -h | --help) usage; exit 0 ;;
    -*) wrong "there is no option $1" ;;
    *) source=$1 ;;
  esac
  shift
done
. "$(dirname "$0")/environment.sh"

read -ra words <<<"$source"
into_files=yes
format=${format:-slices}
case $format in
  slices) into_files=no; read -ra stage <<<"$encoder" ;;
  clouds) into_files=no; stage=(scanassembler) ;;
  pcd) stage=(pcdenc) ;;
  pcd-text) stage=(pcdenc binary=false) ;;
  ply) stage=(plyenc) ;;
  ply-text) stage=(plyenc binary=false) ;;
  bin) stage=(identity) ;;
  *) wrong "there is no format $format" ;;
esac
mkdir -p "$output"
case $source in lidartestsrc*) words+=("trajectory-location=$output/trajectory.tum") ;; esac

if [ $into_files = yes ]; then
  (launch -e "${words[@]}" ! scanassembler ! identity eos-after="$((scans + 1))" \
    ! "${stage[@]}" ! multifilesink location="$output/scan%06d.${format%-text}")
else
  # The synthetic sensor must run in real time, as real sensors do.
  case $source in lidartestsrc*) words+=(is-live=true) ;; esac
  pieces() { find "$output" -name 'rec-*.mcap' | wc -l; }
  before=$(pieces)
  launch -e "${words[@]}" ! queue ! "${stage[@]}" \
    ! mcapsink location="$output/rec-%05d.mcap" max-file-duration="${piece}000000000" &
  recorder=$!
  trap 'kill -INT $recorder 2>/dev/null || true' INT TERM
  # The time counts from the first scan, because a slow machine needs seconds to start.
  SECONDS=0 told=no
  until [ "$(pieces)" -gt "$before" ] || ! kill -0 $recorder 2>/dev/null; do
    sleep 0.05
    [ $told = yes ] || [ $SECONDS -lt 10 ] || { echo "No scan has come for 10 s; waiting for the first." >&2; told=yes; }
  done
  sleep "$seconds" &
  wait -n || true
  kill -INT $recorder 2>/dev/null || true
  kill $! 2>/dev/null || true
  wait $recorder
  [ "$(pieces)" -gt "$before" ] || { echo "Nothing was recorded: no scan has come." >&2; exit 1; }
fi
ls "$output"
