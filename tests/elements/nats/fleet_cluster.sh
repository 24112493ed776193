#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Kills workers and servers of a fleet on the loopback interface, and prints the interruptions that
# this causes (docs/results/fleet.md). This script is run by hand: it takes minutes, and its figures
# are valid only if the machine is otherwise idle.
set -euo pipefail
. "$(cd "$(dirname "$0")" && pwd)/fleet_environment.sh"
exec "$build/tests/elements/nats/fleet-cluster" --gtest_filter='FleetCluster.*'
