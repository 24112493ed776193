// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/mcap/sample_layout.h"

#include "src/cdr/motion_samples.h"

namespace lidar::gst {

bool IsOurImu(const GstCaps* caps) {
  const GstStructure* s = gst_caps_get_structure(caps, 0);
  gint size = 0;
  return gst_structure_get_int(s, "sample-size", &size) && size == gint{cdr::kImuSampleSize} &&
         g_strcmp0(gst_structure_get_string(s, "fields"), cdr::kImuFields) == 0;
}

}  // namespace lidar::gst
