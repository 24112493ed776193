#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# A LiDAR stream over DTLS-SRTP on loopback: each end trusts the certificate of the other only.
set -euo pipefail
source "$(dirname "$0")/options.sh"

usage() {
  cat <<'EOF'
Usage: pipelines/secure-dtls.sh [SECONDS]

A LiDAR stream over DTLS-SRTP on loopback: each end has a certificate and trusts that of the other only;
a stranger is refused.

  SECONDS   how long it sends (default 5)

The environment variable PORT is the first of the UDP ports to use (default 5064).
EOF
}

only_count SECONDS "$@"
source "$(dirname "$0")/environment.sh"
seconds=${1:-5}
port=${PORT:-5064}
back=$((port + 2))
launch=$build/src/tools/lidar-dtls-launch

need gstreamer1.0-plugins-bad dtlssrtpenc srtpenc
folder=$(mktemp -d)
trap 'kill "${receiver:-}" 2>/dev/null || true; rm -rf "$folder"' EXIT

# certificate NAME: makes a key and a self-signed certificate. Each end gets only the certificate of
# the other end, and not its key.
certificate() {
  openssl req -x509 -newkey rsa:2048 -nodes -days 365 -subj "/CN=$1" -keyout "$folder/key" -out "$folder/$1.crt" 2>/dev/null
  (umask 077; cat "$folder/$1.crt" "$folder/key" >"$folder/$1.pem")
}
for name in robot edge stranger; do certificate $name; done

fail() { echo "FAILED: $*" >&2; exit 1; }

media=media=application,clock-rate=90000,encoding-name=X-LIDAR-DRACO,payload=96
# The first capssetter gives dtlssrtpdec buffers of its own, because srtpdec changes buffers in
# place. The second capssetter sets the caps of the RTP stream.
receive() {
  exec "$launch" --certificate "$folder/edge.pem" --peer-certificate "$folder/robot.crt" --stats rx,depay \
    ecnudpsrc port="$port" caps=application/x-srtp ! capssetter caps=application/x-srtp ! dtlssrtpdec name=dec connection-id=edge \
    dec.rtp_src ! capssetter caps=application/x-rtp,$media ! screamrx name=rx ! rtplidardepay name=depay ! lidardec ! \
    fakesink sync=false async=false \
    rx.rtcp_src ! enc.rtcp_sink_0 dtlssrtpenc name=enc connection-id=edge ! ecnudpsink host=127.0.0.1 port="$back" sync=false async=false
}
await_receiver() { listening "$port" "$receiver" || fail "the receiver did not start"; }
# send CERTIFICATE: sends a stream with this certificate. The packet-overhead is 28 bytes of UDP and
# IP, and 10 bytes of SRTP.
send() {
  exec timeout --foreground --signal=INT $((seconds + 600)) "$launch" --certificate "$folder/$1.pem" --peer-certificate "$folder/edge.crt" --stats tx \
    --duration "$seconds" \
    lidartestsrc is-live=true model=os0-32 mode=512x10 ! lidarenc max-error=0.05 ! rtplidarpay ! \
    screamtx name=tx packet-overhead=38 ! \
    enc.rtp_sink_0 dtlssrtpenc name=enc connection-id=robot is-client=true ! ecnudpsink host=127.0.0.1 port="$port" sync=false async=false \
    ecnudpsrc port="$back" caps=application/x-srtcp ! capssetter caps=application/x-srtcp ! \
    dtlssrtpdec name=dec connection-id=robot dec.rtcp_src ! tx.rtcp_sink
}
# send_stranger: sends with the stranger's certificate until the receiver has refused it, or until
# the sender has ended.
send_stranger() {
  send stranger >/dev/null 2>&1 & local stranger=$!
  until grep -q REFUSED "$folder/refused" || ! kill -0 $stranger 2>/dev/null; do sleep 0.1; done
  kill $stranger 2>/dev/null || true
  wait $stranger || true
}
# statistic FILE NAME: prints the number NAME of the statistics in FILE.
statistic() { grep -oE "[ ,]$2=\(guint64\)[0-9]+" "$1" | grep -oE '[0-9]+$'; }

receive >"$folder/received" & receiver=$!
await_receiver
(send robot) >"$folder/sent" || fail "the robot did not reach the edge"
kill -INT $receiver
wait $receiver
slices=$(statistic "$folder/received" slices-received)
lost=$(statistic "$folder/received" slices-lost)
reports=$(statistic "$folder/sent" feedback-accepted)
echo "over DTLS-SRTP: $slices slices, $lost lost, $reports reports of feedback; $(grep -o 'ecn-state=(string)[a-z-]*' "$folder/sent")"
[ "$slices" -gt 0 ] || fail "no slice came"
[ "$lost" = 0 ] || [ "$(statistic "$folder/sent" frames-dropped)" -gt 0 ] || fail "slices were lost"
[ "$reports" -gt 0 ] || fail "no report came back"
grep -q 'ecn-state=(string)capable' "$folder/sent" || fail "ECN marks do not come through"

# The receiver refuses the stranger, and then waits for the robot.
receive >"$folder/received" 2>"$folder/refused" & receiver=$!
await_receiver
send_stranger
[ "$(grep -c REFUSED "$folder/refused")" = 1 ] || fail "a stranger was not refused"
(send robot) >/dev/null || fail "the stranger kept out the robot"
kill -INT $receiver
status=0
wait $receiver || status=$?
slices=$(statistic "$folder/received" slices-received)
echo "a stranger's certificate: $(cat "$folder/refused") $slices slices of the robot came then."
[ $status = 0 ] && [ "$slices" -gt 0 ] || fail "the stranger kept out the robot"

receive >/dev/null 2>"$folder/refused" & receiver=$!
await_receiver
send_stranger
kill -INT $receiver
status=0
wait $receiver || status=$?
[ $status = 3 ] || fail "exit code $status though only a stranger came"
