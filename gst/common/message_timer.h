// SPDX-License-Identifier: LGPL-2.1-or-later
// When the next of a series of element messages is due.
#pragma once
#include <gst/gst.h>

#include <optional>

#include "src/base/units.h"

namespace lidar::gst {

class MessageTimer {
 public:
  /// True where `interval` has passed since the last time, or since the first call. 0: never.
  bool IsDue(Duration interval) {
    const gint64 now_us = g_get_monotonic_time();
    if (!last_us_) last_us_ = now_us;
    if (interval <= Duration{} || now_us - *last_us_ < interval.count() / 1000) return false;
    last_us_ = now_us;
    return true;
  }

 private:
  std::optional<gint64> last_us_;
};

}  // namespace lidar::gst
