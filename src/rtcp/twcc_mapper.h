// SPDX-License-Identifier: LGPL-2.1-or-later
// Maps the packet numbers of transport-wide feedback (TWCC,
// draft-holmer-rmcat-transport-wide-cc-extensions-01) to SSRCs and sequence numbers, by which the
// controller counts packets. An rtpsession reads the feedback packets.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "src/base/sequence.h"
#include "src/rtcp/ccfb.h"
#include "src/rtcp/report_clock.h"

namespace lidar::rtcp {

/// URI of the RTP header extension with the packet numbers.
constexpr const char* kTwccUri =
    "http://www.ietf.org/id/draft-holmer-rmcat-transport-wide-cc-extensions-01";
/// Period of arrival times, 12 days.
constexpr Duration kTwccPeriod = std::chrono::milliseconds(64) * (1 << 24);
/// Number of packets that can be distinguished: half of the numbers.
constexpr std::size_t kMaxTwccPackets = 1 << 14;

struct TwccFeedback {
  std::uint16_t base_number = 0;
  /// Arrival times of base_number, base_number + 1, ... on the receiver's clock; unset: not
  /// received.
  std::vector<std::optional<Duration>> arrivals;
};

/// The sender's side. TWCC has no ECN bits and no report time: packets count as Not-ECT, and the
/// last arrival in a report counts as the report's time.
class TwccMapper {
 public:
  void OnSent(std::uint16_t number, std::uint32_t ssrc, std::uint16_t seq);
  /// Leaves out numbers that were never sent, or sent too long ago. Returns nothing if no number
  /// remains.
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
