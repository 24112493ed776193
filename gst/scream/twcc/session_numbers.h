// SPDX-License-Identifier: LGPL-2.1-or-later
// The transport-wide numbers that an rtpsession behind us gives to our packets, and its reports.
#pragma once
#include <gst/gst.h>

#include <cstdint>
#include <deque>
#include <optional>

#include "src/scream/feedback/twcc_mapper.h"

namespace lidar::gst {

/// rtpsession numbers the packets that have the extension, from 0 on, in their order, and reports
/// them in an upstream event with their sizes. Not thread-safe.
class SessionNumbers {
 public:
  struct Stats {
    guint64 reports = 0;
    guint64 packets = 0;
    guint64 mismatched = 0;  // reports about packets that were not ours
  };

  /// Learns the id of the extension from the session's caps; packets of other caps have none.
  void OnCaps(const GstCaps* caps);
  /// A packet goes into the session.
  void OnPacket(GstBuffer* buffer);
  /// The report in an event of rtpsession; nothing for other events, or if no packet is ours.
  std::optional<scream::CongestionFeedback> OnEvent(GstEvent* event);
  const Stats& stats() const { return stats_; }

 private:
  bool IsOurs(const GstStructure* packet) const;

  guint8 id_ = 0;  // 0: the caps have none
  std::uint16_t next_ = 0;
  std::deque<guint> sizes_;  // payload bytes of the packets before next_
  scream::TwccMapper mapper_;
  Stats stats_;
};

}  // namespace lidar::gst
