#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Tests that each program prints its version.
# usage: version_test.sh VERSION PROGRAM ...
set -uo pipefail
version=$1
shift
for program in "$@"; do
  said=$("$program" --version)
  [ "$said" = "$(basename "$program") (gst-lidar) $version" ] || { echo "$program says: $said"; exit 1; }
done
