// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension burst_probe: what a source that sends little goes out in short bursts, to measure by.
#pragma once
#include <algorithm>
#include <optional>

#include "src/scream/parameters.h"

namespace lidar::scream {

/// A source that leaves its target unused tells nothing about the link. The starts of its frames,
/// sent faster, do. No byte is added, the send window holds, and the first sign of congestion ends
/// it.
class BurstProbe {
 public:
  struct Input {
    bool limited = false;    ///< the source sends much less than it is asked for
    bool congested = false;  ///< lately
    DataRate known;          ///< what the link is known to carry
    DataRate wanted;         ///< more than this is of no use
  };

  explicit BurstProbe(const Parameters& parameters) : p_(parameters) {}

  /// As a frame begins. Returns the rate at which its first packets may leave.
  std::optional<DataRate> Update(Time now, const Input& in) {
    if (!p_.extensions.burst_probe) return std::nullopt;
    const bool useful = in.limited && !in.congested && in.known < in.wanted;
    if (!useful) useful_since_.reset();
    if (useful && !useful_since_) useful_since_ = now;
    // A target that rises is ahead of what is sent.
    if (!started_ && useful && now - *useful_since_ >= kSettled && now >= next_) started_ = now;
    if (!started_) return std::nullopt;
    if (!useful || now - *started_ >= kLongest) {
      started_.reset();
      next_ = now + kPause;
      return std::nullopt;
    }
    return std::min(in.known * kFaster, in.wanted * kFaster);
  }
  /// How long a burst lasts. Half of it is a queue where the link is not faster than was known.
  static constexpr Duration kBurst = std::chrono::milliseconds(8);

 private:
  static constexpr double kFaster = 2;
  static constexpr Duration kSettled = std::chrono::seconds(2);
  static constexpr Duration kLongest = std::chrono::seconds(3);
  static constexpr Duration kPause = std::chrono::seconds(10);
  const Parameters& p_;
  std::optional<Time> useful_since_, started_;
  Time next_{};
};

}  // namespace lidar::scream
