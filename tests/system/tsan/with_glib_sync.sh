#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Runs a test with the library of tests/system/tsan/glib_sync.cpp preloaded. This is a wrapper for
# `meson test --wrapper`.
LD_PRELOAD=$LIDAR_PRELOAD exec "$@"
