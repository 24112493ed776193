// SPDX-License-Identifier: LGPL-2.1-or-later
// A sink pad of foxglovesink: the ghost of an input, with its topic and frame.
#pragma once
#include <gst/gst.h>

G_BEGIN_DECLS
#define GST_TYPE_LIDAR_FOXGLOVE_PAD (gst_lidar_foxglove_pad_get_type())
G_DECLARE_FINAL_TYPE(GstLidarFoxglovePad, gst_lidar_foxglove_pad, GST, LIDAR_FOXGLOVE_PAD,
                     GstGhostPad)
G_END_DECLS

namespace lidar::web {
/// The element behind the pad, or NULL while there is none; transfer full.
GstElement* InputOf(GstPad* pad);
}  // namespace lidar::web
