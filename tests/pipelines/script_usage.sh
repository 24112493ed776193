#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Tests the command lines of the scripts in pipelines/ and of the scripts that run for hours. Each
# script prints help, and refuses a wrong option at once with a reason. Nothing is streamed.
set -uo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
failed=0

# expect CODE TEXT SCRIPT [options]: expects that the script ends with exit code CODE and prints
# TEXT.
expect() {
  local code=$1 text=$2 script=$3 output status
  shift 3
  output=$(timeout 180 "$root/pipelines/$script" "$@" 2>&1)
  status=$?
  if [ "$status" != "$code" ] || ! grep -qF -- "$text" <<<"$output"; then
    printf '%s %s: code %s instead of %s, or no "%s" in:\n%s\n' "$script" "$*" "$status" "$code" "$text" "$output" >&2
    failed=1
  fi
}

for script in lidar-and-video rtpbin-video record play view secure secure-dtls webrtc rtsp demo; do
  expect 0 "Usage: pipelines/$script.sh" $script.sh --help
done
for script in lidar-and-video rtpbin-video record play view secure secure-dtls webrtc rtsp; do
  expect 2 "there is no option --nonsense" $script.sh --nonsense
done
expect 2 '--rate wants a number above zero, not "abc"' lidar-and-video.sh --rate abc
expect 2 '--rate wants a number' lidar-and-video.sh --rate 0
expect 2 '--duration wants a value' lidar-and-video.sh --duration
expect 2 '--trace wants a file that can be read' lidar-and-video.sh --trace no-such-file
expect 2 '--port wants a UDP port' lidar-and-video.sh --port 70000
expect 2 '--duration wants a number' rtpbin-video.sh --duration ten
expect 2 '--low wants a number above zero' webrtc.sh --low 0
expect 2 '--scans wants a value' record.sh --scans
expect 2 '--scans wants a whole number' record.sh --scans 1.5
expect 2 'there is no format las' record.sh --format las
expect 2 'there is no way to play to disk' play.sh --to disk
expect 2 '--send wants HOST:PORT' play.sh --send edge
expect 2 '--scan wants a whole number' view.sh --scan first
expect 2 '--scan wants a whole number' view.sh --scan 08
expect 2 'SECONDS wants a whole number' secure.sh five
expect 2 'CLOUDS wants a whole number' rtsp.sh 1.5
expect 2 'there is nothing to say behind SECONDS' secure-dtls.sh 5 6
for script in tests/all.sh tests/other-releases.sh packaging/build-deb.sh; do
  expect 0 "Usage: $script" ../$script --help
done
logs=$(mktemp -d)
trap 'rm -rf "$logs"' EXIT
expect 2 'there is no option --nonsense' ../tests/all.sh --nonsense
expect 2 'there is no step nonsense' ../tests/all.sh --only run,nonsense
expect 2 '--minutes wants a whole number above zero' ../tests/all.sh --minutes ten
SCREAM_REFERENCE='' expect 0 'needs SCREAM_REFERENCE' ../tests/all.sh --only interop --output "$logs"
SCREAM_REFERENCE='' expect 0 '0 of 0 failed' ../tests/all.sh --only interop --skip interop --output "$logs"
expect 2 'Usage:' ../tests/other-releases.sh
expect 2 "Unknown option '--nonsense'" ../tests/other-releases.sh --nonsense
expect 2 "Unknown option '--nonsense'" ../packaging/build-deb.sh --nonsense
exit $failed
