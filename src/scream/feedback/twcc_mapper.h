// SPDX-License-Identifier: LGPL-2.1-or-later
// Turns the numbers of transport-wide feedback (TWCC, draft-holmer-rmcat-transport-wide-cc-
// extensions-01) back into packets of SSRCs, so that its reports reach a controller that counts by
// SSRC. An rtpsession reads the packets themselves.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "src/base/sequence.h"
#include "src/scream/feedback/ccfb.h"
#include "src/scream/feedback/report_clock.h"

namespace lidar::scream {

/// The URI of the RTP header extension that numbers the packets.
constexpr const char* kTwccUri =
    "http://www.ietf.org/id/draft-holmer-rmcat-transport-wide-cc-extensions-01";
/// Arrival times repeat after this, 12 days.
constexpr Duration kTwccPeriod = std::chrono::milliseconds(64) * (1 << 24);
/// Half of the numbers are the most that can be told apart.
constexpr std::size_t kMaxTwccPackets = 1 << 14;

struct TwccFeedback {
  std::uint16_t base_number = 0;
  /// When base_number, base_number + 1, ... arrived, by the receiver's clock; none: not received.
  std::vector<std::optional<Duration>> arrivals;
};

/// The sender's side. TWCC carries no ECN bits and no time of the report itself: a packet counts as
/// Not-ECT, and the report as made when the last of its packets arrived.
class TwccMapper {
 public:
  void OnSent(std::uint16_t number, std::uint32_t ssrc, std::uint16_t seq);
  /// Numbers that were never sent, or long ago, are left out; nothing where none remains.
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
  std::deque<Sent> sent_;  // of first_, first_ + 1, ...
  std::int64_t first_ = 0;
  std::optional<Duration> newest_;  // arrival, without wrapping around
};

}  // namespace lidar::scream
