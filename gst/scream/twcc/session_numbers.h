// SPDX-License-Identifier: LGPL-2.1-or-later
// The transport-wide numbers that a downstream rtpsession gives to our packets, and the reports
// about these numbers.
#pragma once
#include <gst/gst.h>

#include <cstdint>
#include <deque>
#include <optional>

#include "src/rtcp/twcc_mapper.h"

namespace lidar::gst {

/// Tracks the numbers of packets that have the TWCC extension. rtpsession numbers these packets in
/// order, from 0. It reports the packets, with their sizes, in an event upstream. Not thread-safe.
class SessionNumbers {
 public:
  struct Stats {
    guint64 reports = 0;
    guint64 packets = 0;
    guint64 mismatched = 0;  // reports about packets that did not pass here
  };

  /// Reads the id of the TWCC extension from the session's caps. If `caps` have no id, packets are
  /// not tracked.
  void OnCaps(const GstCaps* caps);
  /// Call it for each packet that goes to the session.
  void OnPacket(GstBuffer* buffer);
  /// Returns the report in an event of rtpsession. Returns nothing for another event, or if a
  /// reported packet is not ours.
  std::optional<rtcp::CongestionFeedback> OnEvent(GstEvent* event);
  const Stats& stats() const { return stats_; }
  /// Resets the counters for another run. The numbers continue, because the session continues them.
  void ResetStats() { stats_ = {}; }

 private:
  bool IsOurs(const GstStructure* packet) const;

  guint8 id_ = 0;  // 0: the caps have no id
  std::uint16_t next_ = 0;
  std::deque<guint> sizes_;  // payload bytes of the last packets before next_
  rtcp::TwccMapper mapper_;
  Stats stats_;
};

}  // namespace lidar::gst
