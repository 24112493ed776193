// SPDX-License-Identifier: LGPL-2.1-or-later
// Records which packets of a stream were received, for the stream's payloader.
#pragma once
#include <vector>

#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "src/rtcp/ccfb.h"

namespace lidar::gst {

/// Call its methods with the element's lock held.
class PacketReceipts {
 public:
  void Add(guint receiver, const rtcp::SsrcReport& report);
  bool empty() const { return receipts_.empty(); }
  /// Removes all receipts and returns them as events for upstream.
  std::vector<EventPtr> Take();

 private:
  // Further receipts are dropped. The payloader then counts their slices as lost, which does no
  // harm.
  static constexpr std::size_t kMostReceipts = 16;
  std::vector<GstLidarPacketsReceived> receipts_;
};

}  // namespace lidar::gst
