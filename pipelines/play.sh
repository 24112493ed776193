#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Plays a recording to a window, to files, or as a stream to another machine.
set -euo pipefail
source "$(dirname "$0")/options.sh"

usage() {
  cat <<'USAGE'
Usage: pipelines/play.sh [options] [LOCATION]

  LOCATION        an MCAP file, or the files of a recording as rec-%05d.mcap
                  (default record-output/rec-%05d.mcap)
  --to WHAT       window (default); pcd, pcd-text, ply or ply-text: one file a scan; none: as fast as
                  it goes, to see whether all of it can be read
  --send HOST:PORT  send the recorded slices by RTP under congestion control instead
  --topic T       play that topic (default /slices)
  --decoder D     of the slices: lidardec (default) or dracodec; none: the topic holds clouds
  --output DIR    where files go (default play-output)
USAGE
}

location=record-output/rec-%05d.mcap
to=window
send=
topic=/slices
decoder=lidardec
output=play-output
while [ $# -gt 0 ]; do
  case $1 in
    --to) text "$@"; to=$2; shift ;;
    --send) text "$@"; send=$2; shift ;;
    --topic) text "$@"; topic=$2; shift ;;
    --decoder) text "$@"; decoder=$2; shift ;;
    --output) text "$@"; output=$2; shift ;;
    -h | --help) usage; exit 0 ;;
    -*) wrong "there is no option $1" ;;
    *) location=$1 ;;
  esac
  shift
done
. "$(dirname "$0")/environment.sh"

case $decoder in
  lidardec | dracodec) decode=("$decoder" ! scanassembler) ;;
  none) decode=(identity) ;;
  *) wrong "there is no decoder $decoder" ;;
esac
if [ -n "$send" ]; then
  [[ $send =~ ^(.+):([0-9]+)$ ]] || wrong "--send wants HOST:PORT, not \"$send\""
  # A recording is not a live source, so identity delays its buffers until they are due.
  sink=(identity sync=true ! rtplidarpay ! screamsink host="${BASH_REMATCH[1]}" port="${BASH_REMATCH[2]}")
  decode=(identity)
else
  case $to in
    window) sink=(pointcloudview ! videoconvert ! autovideosink) ;;
    pcd) sink=(pcdenc) ;;
    pcd-text) sink=(pcdenc binary=false) ;;
    ply) sink=(plyenc) ;;
    ply-text) sink=(plyenc binary=false) ;;
    none) sink=(fakesink sync=false) ;;
    *) wrong "there is no way to play to $to" ;;
  esac
  case $to in
    pcd* | ply*)
      mkdir -p "$output"
      sink+=(! multifilesink location="$output/scan%06d.${to%-text}") ;;
  esac
fi
launch -e mcapsrc location="$location" topic="$topic" ! queue ! "${decode[@]}" ! "${sink[@]}"
