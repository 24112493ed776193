// SPDX-License-Identifier: LGPL-2.1-or-later
// Transport-wide numbers that a downstream rtpsession gives to our packets, and its reports.
#pragma once
#include <gst/gst.h>

#include <cstdint>
#include <deque>
#include <optional>

#include "src/rtcp/twcc_mapper.h"

namespace lidar::gst {

/// rtpsession numbers packets that have the extension, in order from 0, and reports them with their
/// sizes in an upstream event. Not thread-safe.
class SessionNumbers {
 public:
  struct Stats {
    guint64 reports = 0;
    guint64 packets = 0;
    guint64 mismatched = 0;  // reports about packets of others
  };

  /// Reads the extension's id from the session's caps. Other caps have no id.
  void OnCaps(const GstCaps* caps);
  /// Notes a packet on its way to the session.
  void OnPacket(GstBuffer* buffer);
  /// Returns the report in an event of rtpsession. Returns nothing for other events, or if no
  /// packet is ours.
  std::optional<rtcp::CongestionFeedback> OnEvent(GstEvent* event);
  const Stats& stats() const { return stats_; }
  /// Begins another run. The session's numbers go on.
  void ResetStats() { stats_ = {}; }

 private:
  bool IsOurs(const GstStructure* packet) const;

  guint8 id_ = 0;  // 0: the caps have no id
  std::uint16_t next_ = 0;
  std::deque<guint> sizes_;  // payload bytes of the packets up to next_
  rtcp::TwccMapper mapper_;
  Stats stats_;
};

}  // namespace lidar::gst
