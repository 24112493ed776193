// SPDX-License-Identifier: LGPL-2.1-or-later
// The debug category of the plugin. Include this file last.
#pragma once
#include <gst/gst.h>

GST_DEBUG_CATEGORY_EXTERN(gst_lidar_ouster_src_debug);
#define GST_CAT_DEFAULT gst_lidar_ouster_src_debug
