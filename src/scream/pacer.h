// SPDX-License-Identifier: LGPL-2.1-or-later
// Draft section "Packet Pacing".
#pragma once
#include <algorithm>
#include <cstdint>
#include <utility>

#include "src/scream/parameters.h"

namespace lidar::scream {

class Pacer {
 public:
  explicit Pacer(const Parameters& parameters) : p_(parameters) {}

  /// `headroom` is PACKET_PACING_HEADROOM, or the value by which an extension replaces it. Near the
  /// maximum bitrate, the pace is relaxed up to `relaxed_max`.
  void Update(DataRate target_bitrate, DataRate target_bitrate_max, double headroom,
              DataRate relaxed_max = DataRate::Infinite()) {
    const DataRate strict = std::max(p_.rate_pace_min, target_bitrate) * headroom;
    const double low = p_.relaxed_pacing_limit_low;
    const double relaxed = std::min(1.0, (target_bitrate / target_bitrate_max - low) / (1 - low));
    pace_bitrate_ = strict / std::clamp(1 - relaxed, 1 / p_.max_relaxed_pacing_factor, 1.0);
    pace_bitrate_ = std::min(pace_bitrate_, std::max(strict, relaxed_max));
  }
  /// Makes the gaps between packets longer and shorter by `ripple`, so that the packets of other
  /// flows can be detected.
  void set_ripple(Duration ripple) { ripple_ = ripple; }
  /// Paces packets so that a link with the rate `link` would queue them for at most `longest`. If a
  /// frame is too large for this, its rest is sent at the rate `link`.
  void LimitQueue(DataRate link, Duration longest) {
    link_ = link;
    longest_queue_ = longest;
  }
  void RaiseTo(DataRate rate) {
    pace_bitrate_ = std::max(pace_bitrate_, rate);
    link_ = std::max(link_, rate);
  }
  /// Call it when a packet enters an empty queue. The idle time before this packet gives no credit
  /// for a burst.
  void OnIdleEnd(Time now) { next_ = std::max(next_, now); }
  /// Call it after a gap. The next packet is then due at once, although the rate in the gap was
  /// low.
  void OnGapEnd(Time now) { next_ = std::min(next_, now); }
  /// Sets the time of the next packet, counted from the time at which this packet was due. If this
  /// packet was sent late, at most `pacing_catch_up` of the delay is caught up.
  void OnSent(Time now, DataSize size) {
    const Duration gap = size / pace_bitrate_;
    next_ = std::max(next_, now - p_.pacing_catch_up) + gap;
    if (link_ < DataRate::Infinite()) {
      queue_ = std::max(DataSize(), queue_ - link_ * (now - std::exchange(last_sent_, now))) + size;
      next_ = std::max(next_, now + queue_ / link_ - longest_queue_);
    }
    const Duration ripple = std::min(ripple_, gap / 2);
    next_ += LongerGap() ? ripple : -ripple;
  }
  Time next() const { return next_; }
  DataRate pace_bitrate() const { return pace_bitrate_; }

 private:
  /// Returns true for one gap of each pair. The order has no period (it is the sequence of Thue and
  /// Morse).
  bool LongerGap() {
    bool odd = false;
    for (std::uint32_t bits = gaps_++; bits != 0; bits &= bits - 1) odd = !odd;
    return odd;
  }

  const Parameters& p_;
  DataRate pace_bitrate_ = DataRate::BitsPerSecond(1e6);
  Duration ripple_{0};
  std::uint32_t gaps_ = 0;
  DataRate link_ = DataRate::Infinite();
  Duration longest_queue_{0};
  DataSize queue_;  // queue of a link with rate link_
  Time last_sent_{};
  Time next_{};
};

}  // namespace lidar::scream
