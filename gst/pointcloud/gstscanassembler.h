// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once
#include <gst/gst.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_SCAN_ASSEMBLER (gst_lidar_scan_assembler_get_type())
G_DECLARE_FINAL_TYPE(GstLidarScanAssembler, gst_lidar_scan_assembler, GST, LIDAR_SCAN_ASSEMBLER,
                     GstElement)
GST_ELEMENT_REGISTER_DECLARE(scanassembler)
G_END_DECLS
