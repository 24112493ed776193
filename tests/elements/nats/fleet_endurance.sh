#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Runs a whole fleet on the loopback interface, kills its servers, its edge and its workers, and
# keeps books of every slice (docs/results/fleet.md). This script is run by hand. It fails if an
# acknowledged slice is lost, or if a slice is lost that no part counted.
set -euo pipefail
usage() {
  cat >&2 <<'END'
usage: fleet_endurance.sh [OPTIONS]
  --robots N       robots, each with a SCReAM of its own (20)
  --slam N         of which so many have workers that find their poses (4)
  --minutes M      (10)
  --kill-every S   seconds from one kill to the next, on average; 0: nothing is killed (15)
  --seed N         of the kills (1)
END
  exit 2
}
while [ $# -gt 0 ]; do
  case $1 in
    --robots | --slam | --minutes | --kill-every | --seed)
      [[ ${2:-} =~ ^[0-9.]+$ ]] || usage
      name=${1#--} name=${name//-/_}
      export "FLEET_${name^^}=$2"
      shift 2
      ;;
    *) usage ;;
  esac
done
. "$(cd "$(dirname "$0")" && pwd)/fleet_environment.sh"
exec "$build/tests/elements/nats/fleet-cluster" --gtest_filter='FleetEndurance.*'
