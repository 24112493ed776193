// SPDX-License-Identifier: LGPL-2.1-or-later
// Received packets of a stream, kept for its payloader.
#pragma once
#include <vector>

#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "src/rtcp/ccfb.h"

namespace lidar::gst {

/// Call with the element's lock held.
class PacketReceipts {
 public:
  void Add(guint receiver, const rtcp::SsrcReport& report);
  bool empty() const { return receipts_.empty(); }
  /// Returns upstream events with all receipts.
  std::vector<EventPtr> Take();

 private:
  // A payloader without some receipts counts their slices as lost, which does no harm.
  static constexpr std::size_t kMostReceipts = 16;
  std::vector<GstLidarPacketsReceived> receipts_;
};

}  // namespace lidar::gst
