#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Runs the commands of docs/tutorials/two-links.md as they are printed there, in network namespaces:
# tutorial_test.sh ROOT
set -euo pipefail
page=$1/docs/tutorials/two-links.md
robot=lidar-robot$$
edge=lidar-edge$$
folder=$(mktemp -d)
finish() {
  local status=$?
  for end in "$robot" "$edge"; do ip netns pids "$end" 2>/dev/null | xargs -r kill -KILL || true; done
  ip netns del "$robot" 2>/dev/null || true
  ip netns del "$edge" 2>/dev/null || true
  [ "$status" = 0 ] || [ "$status" = 77 ] || tail -n 20 "$folder"/*.log >&2
  rm -rf "$folder"
}
trap finish EXIT
if ! { ip netns add "$robot" && ip netns add "$edge"; } 2>/dev/null; then
  echo "networks need root and iproute2"
  exit 77
fi

# printed PATTERN: prints the commands of the page that begin with PATTERN.
printed() { grep -E "^    $1" "$page" | sed 's/^    //'; }
on() { ip netns exec "$@"; }
wait_for() {
  local file=$1 text=$2
  for _ in $(seq 600); do
    grep -q -- "$text" "$file" && return
    sleep 0.1
  done
  echo "$file lacks $text" >&2
  return 1
}

for i in 0 1; do
  ip -n "$robot" link add "wwan$i" type veth peer name "gate$i" netns "$edge"
  ip -n "$robot" addr add "10.6$((4 + i)).0.2/24" dev "wwan$i"
  ip -n "$edge" addr add "10.6$((4 + i)).0.1/24" dev "gate$i"
  ip -n "$robot" link set "wwan$i" up
  ip -n "$edge" link set "gate$i" up
done
ip -n "$edge" link set lo up
ip -n "$edge" addr add 203.0.113.1/32 dev lo
printed 'ip route add|    sysctl' > "$folder/routes.sh"
on "$robot" bash -e "$folder/routes.sh"
on "$robot" ip route get 203.0.113.1 oif wwan1 | grep -q 'via 10.65.0.1'

export LIDAR_SRTP_KEY
LIDAR_SRTP_KEY=$(printf '5%.0s' {1..60})
printed 'exec gst-launch-1.0 screamsrc' | sed 's/fakesink/fakesink silent=false -v/' > "$folder/edge.sh"
printed 'exec gst-launch-1.0 -e' | sed 's/-e/-e -m/' > "$folder/robot.sh"
on "$edge" bash "$folder/edge.sh" > "$folder/edge.log" 2>&1 &
wait_for "$folder/edge.log" 'Setting pipeline to PLAYING'
on "$robot" bash "$folder/robot.sh" > "$folder/robot.log" 2>&1 &
wait_for "$folder/edge.log" 'last-message = chain'
printed 'ip link set' > "$folder/unplug.sh"
on "$robot" bash -e "$folder/unplug.sh"
wait_for "$folder/robot.log" 'scream-link-changed.*wwan0.*usable=(boolean)false'
before=$(grep -c 'last-message = chain' "$folder/edge.log")
for _ in $(seq 600); do
  [ "$(grep -c 'last-message = chain' "$folder/edge.log")" -ge $((before + 10)) ] && exit 0
  sleep 0.1
done
echo "the stream did not go on" >&2
exit 1
