// SPDX-License-Identifier: LGPL-2.1-or-later
// Turns transport-wide numbers back into packets of SSRCs, so that TWCC reports reach a controller
// that counts by SSRC.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>

#include "src/base/sequence.h"
#include "src/scream/feedback/ccfb.h"
#include "src/scream/feedback/report_clock.h"
#include "src/scream/feedback/twcc.h"

namespace lidar::scream {

/// The sender's side. TWCC carries no ECN bits and no time of the report itself: a packet counts as
/// Not-ECT, and the report as made when the last of its packets arrived.
class TwccMapper {
 public:
  void OnSent(std::uint16_t number, std::uint32_t ssrc, std::uint16_t seq);
  /// Numbers that were never sent, or long ago, are left out; nothing where none remains.
  std::optional<CongestionFeedback> Map(const TwccFeedback& feedback);
  void Reset();

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
