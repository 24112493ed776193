#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Kills workers and servers of a fleet on loopback, and prints what that costs
# (docs/results/fleet.md). Run by hand: it takes minutes, and its figures need an idle machine.
set -euo pipefail
. "$(cd "$(dirname "$0")" && pwd)/fleet_environment.sh"
exec "$build/tests/elements/nats/fleet-cluster" --gtest_filter='FleetCluster.*'
