// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/tx/receipts.h"

namespace lidar::gst {

void PacketReceipts::Add(guint receiver, const rtcp::SsrcReport& report) {
  if (receipts_.size() >= kMostReceipts) return;
  GstLidarPacketsReceived receipt{report.ssrc, receiver, 0, {}};
  bool in_range = false;
  for (std::size_t i = 0; i < report.metrics.size(); ++i) {
    const auto seq = static_cast<guint16>(report.begin_seq + i);
    if (!report.metrics[i].received) {
      in_range = false;
      continue;
    }
    if (in_range) {
      receipt.ranges[receipt.count - 1].last = seq;
      continue;
    }
    if (receipt.count == GST_LIDAR_MAX_RECEIVED) break;
    receipt.ranges[receipt.count++] = {seq, seq};
    in_range = true;
  }
  if (receipt.count > 0) receipts_.push_back(receipt);
}

std::vector<EventPtr> PacketReceipts::Take() {
  std::vector<EventPtr> events;
  for (const GstLidarPacketsReceived& receipt : receipts_)
    events.emplace_back(gst_lidar_event_new_packets_received(&receipt));
  receipts_.clear();
  return events;
}

}  // namespace lidar::gst
