#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# A plugin outside of this tree builds with what is installed, and works: headers, pkg-config, library.
# Usage: outside_plugin_test.sh SOURCE_ROOT BUILD_ROOT
set -euo pipefail
source=$1
build=$2
. "$source/tests/support/installed.sh"

cp "$source/tests/elements/coders/example_coder.cpp" "$work/"
cd "$work"
# shellcheck disable=SC2086
c++ -std=c++17 -O1 -shared -fPIC -DEXAMPLE_PLUGIN -DPACKAGE='"lidarexample"' example_coder.cpp \
  -o libgstlidarexample.so $flags
echo '#include <gst/lidar/gstlidarcloudinfo.h>
#include <gst/lidar/gstlidardecoder.h>
#include <gst/lidar/gstlidarencoder.h>' >header.c
# shellcheck disable=SC2086
cc -std=c99 -Wall -Wextra -Wno-unused-parameter -Werror -fsyntax-only header.c $flags

export GST_PLUGIN_PATH_1_0=$work:$build/gst/testsrc
gst-inspect-1.0 exampleenc >inspected
for property in bitrate max-error min-bitrate degradation-preference error-check stats stats-interval; do
  grep -q "^  $property *:" inspected || { echo "exampleenc has no $property" >&2; exit 1; }
done
gst-launch-1.0 -q lidartestsrc num-buffers=16 model=os1-32 mode=512x10 ! exampleenc ! exampledec ! filesink location=out
[ -s out ] || { echo "nothing came out" >&2; exit 1; }
