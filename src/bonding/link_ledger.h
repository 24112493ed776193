// SPDX-License-Identifier: LGPL-2.1-or-later
// The packets that were sent over one link, and what the receiver reported about them.
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <unordered_map>
#include <vector>

#include "src/base/time.h"
#include "src/bonding/packet_id.h"
#include "src/rtcp/ccfb.h"

namespace lidar::bonding {

/// Converts reports about the packets of one link to numbers of this link. A link carries only some
/// packets of an SSRC, and may carry a copy of an old packet after newer packets. A controller that
/// used the RTP sequence numbers would thus see losses and repetitions. Therefore each SSRC has its
/// own numbers on each link, without gaps, in the order in which its packets are sent over the
/// link.
class LinkLedger {
 public:
  /// The number of packets that are remembered for each SSRC. A report about older packets is
  /// implausible.
  static constexpr std::size_t kMaxPackets = 8192;
  static constexpr std::size_t kMaxSources = 64;

  struct Arrival {
    PacketId id;
    Time sent{};
    std::optional<Duration> age;  // at the report's timestamp
  };
  struct Report {
    rtcp::CongestionFeedback feedback;  // with the numbers of this link
    std::vector<Arrival> arrived;       // reported for the first time
    std::vector<PacketId> missing;      // overtaken by packets that arrived; each is listed once
  };

  /// Call it for each packet that the link sends. Returns the packet's number on this link. The
  /// receiver sends a report at once after a packet with `ends_slice`.
  std::uint16_t OnSent(Time now, PacketId id, bool ends_slice = true);
  /// Converts a report. Returns nothing if the report names packets that were never sent over this
  /// link.
  std::optional<Report> OnFeedback(const rtcp::CongestionFeedback& feedback);
  /// Returns true if all packets in the report were sent over this link.
  bool HasSent(const rtcp::CongestionFeedback& feedback) const;
  /// Returns the sending time of the packet that should have caused the oldest missing report, or
  /// nothing if all packets were reported or overtaken. The receiver sends a report at the end of
  /// each slice, and at the latest after kReportEvery.
  std::optional<Time> waiting_since() const;
  static constexpr Duration kReportEvery = std::chrono::milliseconds(40);

 private:
  struct Packet {
    std::uint16_t seq = 0;
    Time sent{};
    bool ends_slice = false;
    bool settled = false;  // reported as arrived
  };
  struct Source {
    std::deque<Packet> packets;  // numbered first, first + 1, ...
    std::int64_t first = 0;      // number of packets.front()
    // Number of the first packet that was neither reported nor overtaken.
    std::int64_t waiting = 0;
    std::unordered_map<std::uint16_t, std::int64_t> numbers;  // by RTP sequence number

    std::int64_t end() const { return first + static_cast<std::int64_t>(packets.size()); }
    Time ReportOf(std::size_t packet) const;
    Packet& At(std::int64_t number) { return packets[static_cast<std::size_t>(number - first)]; }
  };

  void ForgetSilentSource();
  static void Trim(Source* source);
  static bool Translate(const Source& source, const rtcp::SsrcReport& block, rtcp::SsrcReport* own);
  static void Settle(const rtcp::SsrcReport& own, Source* source, Report* report);

  std::map<std::uint32_t, Source> sources_;
};

}  // namespace lidar::bonding
