#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Builds the programs of docs/using-in-your-code.md with the installed files. Both programs must
# print the same points.
# Usage: apps_test.sh SOURCE_ROOT BUILD_ROOT
set -euo pipefail
source=$1
build=$2
. "$source/tests/support/installed.sh"
export GST_PLUGIN_PATH_1_0=$build/gst/testsrc:$build/gst/pointcloud:$build/gst/lidarcodec

# shellcheck disable=SC2086,SC2046
c++ -std=c++17 "$source/tests/elements/apps/nearest_point.cpp" -o "$work/nearest_point" $flags \
  $(pkg-config --cflags --libs gstreamer-app-1.0)
pipeline="lidartestsrc num-buffers=16 model=os1-32 mode=512x10 ! lidarenc ! lidardec ! scanassembler"
"$work/nearest_point" "$pipeline" >"$work/cpp"
cat "$work/cpp"
[ "$(grep -cE '^[0-9]{19}: \(32, 512\) points, the nearest at [0-9]+\.[0-9]{2} m$' "$work/cpp")" = 2 ]

# Debian's packages of Python modules work only with Debian's Python, which may not be the first one
# in PATH.
for python in python3 /usr/bin/python3 none; do
  "$python" -c 'import numpy; from gi.overrides import _gi_gst' 2>/dev/null && break
done
[ $python != none ] || { echo "there is no python3-gst-1.0 or python3-numpy"; exit 77; }
"$python" "$source/tests/elements/apps/cloud_to_numpy.py" "$pipeline" >"$work/python"
diff "$work/cpp" "$work/python"

# If a pipeline cannot be made, or if its source fails, a program must end with an error and not
# wait.
fails() {
  local status=0
  timeout 180 "$@" >"$work/said" 2>&1 || status=$?
  [ $status = 1 ] && grep -qE 'nosuch|Resource not found' "$work/said" && return
  echo "$*: status $status, and it says: $(cat "$work/said")" >&2
  exit 1
}
for broken in "nosuch ! scanassembler" "filesrc location=/nowhere.pcd ! pointcloudparse"; do
  fails "$work/nearest_point" "$broken"
  fails "$python" "$source/tests/elements/apps/cloud_to_numpy.py" "$broken"
done
