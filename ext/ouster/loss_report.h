// SPDX-License-Identifier: LGPL-2.1-or-later
// Decides when ouster_src reports lost packets.
#pragma once
#include <gst/gst.h>

#include <optional>

namespace lidar::gst {

class LossReport {
 public:
  /// Returns the number of packets that were lost since the last report. Returns nothing if there
  /// are none, or if the last report is less than a second old. `total` is the number of all lost
  /// packets; it decreases if a packet that counted as lost arrives late.
  std::optional<guint64> Take(guint64 total, GstClockTime now) {
    if (total <= reported_) return std::nullopt;
    if (GST_CLOCK_TIME_IS_VALID(last_) && now - last_ < GST_SECOND) return std::nullopt;
    last_ = now;
    const guint64 lost = total - reported_;
    reported_ = total;
    return lost;
  }

 private:
  guint64 reported_ = 0;
  GstClockTime last_ = GST_CLOCK_TIME_NONE;
};

}  // namespace lidar::gst
