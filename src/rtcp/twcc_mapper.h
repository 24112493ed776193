// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts the packet numbers of transport-wide feedback (TWCC,
// draft-holmer-rmcat-transport-wide-cc-extensions-01) to SSRCs and sequence numbers, by which the
// controller identifies packets. An rtpsession parses the feedback packets.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "src/base/sequence.h"
#include "src/rtcp/ccfb.h"
#include "src/rtcp/report_clock.h"

namespace lidar::rtcp {

/// The URI of the RTP header extension that carries the packet numbers.
constexpr const char* kTwccUri =
    "http://www.ietf.org/id/draft-holmer-rmcat-transport-wide-cc-extensions-01";
/// The period after which arrival times repeat, 12 days.
constexpr Duration kTwccPeriod = std::chrono::milliseconds(64) * (1 << 24);
/// The greatest number of packets in a report, and of sent packets that are remembered: a quarter
/// of all numbers.
constexpr std::size_t kMaxTwccPackets = 1 << 14;

struct TwccFeedback {
  std::uint16_t base_number = 0;
  /// The arrival times of base_number, base_number + 1, ... on the receiver's clock. A time is
  /// unset if the packet was not received.
  std::vector<std::optional<Duration>> arrivals;
};

/// Converts feedback at the sender. TWCC has no ECN bits and no time of the report. Packets
/// therefore count as Not-ECT, and the last arrival in a report counts as the time of the report.
class TwccMapper {
 public:
  void OnSent(std::uint16_t number, std::uint32_t ssrc, std::uint16_t seq);
  /// Converts a report. Leaves out numbers that were never sent, or sent too long ago. Returns
  /// nothing if no number remains.
  std::optional<CongestionFeedback> Map(const TwccFeedback& feedback);

 private:
  static constexpr std::int64_t kMaxHistory = kMaxTwccPackets;
  struct Sent {
    bool ours = false;
    std::uint32_t ssrc = 0;
    std::uint16_t seq = 0;
  };

  const Sent* Find(std::uint16_t number) const;
  Duration Unwrap(Duration arrival);

  SequenceUnwrapper<std::uint16_t> numbers_;
  std::deque<Sent> sent_;  // of packets first_, first_ + 1, ...
  std::int64_t first_ = 0;
  std::optional<Duration> newest_;  // newest arrival, without wrap-around
};

}  // namespace lidar::rtcp
