# SPDX-License-Identifier: LGPL-2.1-or-later
# The scripts that run a fleet source this file. It builds the programs of the fleet, and sets the
# variables with their paths.
. "$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/../../../pipelines/environment.sh"
ninja -C "$build" tests/elements/nats/fleet-cluster src/tools/apps/edge/lidar-edge src/tools/apps/worker/lidar-worker >&2
export LIDAR_EDGE=$build/src/tools/apps/edge/lidar-edge LIDAR_WORKER=$build/src/tools/apps/worker/lidar-worker
