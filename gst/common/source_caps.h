// SPDX-License-Identifier: LGPL-2.1-or-later
// Sets the caps of a source in its streaming thread.
#pragma once
#include <gst/base/gstbasesrc.h>

namespace lidar::gst {

/// Sets caps. If the pad is flushing, for example because the element stops, it refuses the caps.
/// This is not an error.
inline GstFlowReturn SetSourceCaps(GstBaseSrc* source, GstCaps* caps) {
  if (gst_base_src_set_caps(source, caps)) return GST_FLOW_OK;
  return GST_PAD_IS_FLUSHING(GST_BASE_SRC_PAD(source)) ? GST_FLOW_FLUSHING
                                                       : GST_FLOW_NOT_NEGOTIATED;
}

}  // namespace lidar::gst
