#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Runs a test with tests/system/tsan/glib_sync.cpp in it; for meson test --wrapper.
LD_PRELOAD=$LIDAR_PRELOAD exec "$@"
