// SPDX-License-Identifier: LGPL-2.1-or-later
// Statistics as element messages, at an interval.
#pragma once
#include <optional>

#include "gst/common/refs.h"
#include "src/base/time.h"

namespace lidar::gst {

class MessageTimer {
 public:
  /// Posts `stats` where `interval` has passed since the last time, or since the first call. 0:
  /// never.
  void Post(GstElement* element, Duration interval, StructurePtr (*stats)(GObject*)) {
    const gint64 now_us = g_get_monotonic_time();
    if (!last_us_) last_us_ = now_us;
    if (interval <= Duration{} || now_us - *last_us_ < interval.count() / 1000) return;
    last_us_ = now_us;
    gst_element_post_message(
        element, gst_message_new_element(GST_OBJECT(element), stats(G_OBJECT(element)).release()));
  }

 private:
  std::optional<gint64> last_us_;
};

}  // namespace lidar::gst
