// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/link/gaps.h"

#include <algorithm>

namespace lidar::link {
namespace {

using namespace std::chrono_literals;

constexpr DataRate kGapRate = DataRate::BitsPerSecond(5e5);
constexpr Duration kGrain = 10ms;
constexpr Duration kWindow = 100ms;
constexpr Duration kLongest = 5s;

/// Counts the bits that entered the link in each bin of kGrain.
class SentBits {
 public:
  SentBits(const std::vector<SentPacket>& packets, Duration duration)
      : bits_(static_cast<std::size_t>(std::max(duration, Duration{0}) / kGrain) + 1) {
    for (const SentPacket& p : packets) {
      const auto i = static_cast<std::size_t>(std::max(p.time, Duration{0}) / kGrain);
      if (i < bits_.size()) bits_[i] += p.size.bits();
    }
  }
  double In(Duration from, Duration length) const {
    double sum = 0;
    for (Duration t = from; t < from + length; t += kGrain) {
      const auto i = static_cast<std::size_t>(t / kGrain);
      if (i < bits_.size()) sum += bits_[i];
    }
    return sum;
  }

 private:
  std::vector<double> bits_;
};

}  // namespace

std::vector<Duration> EndsOfGaps(const Capacity& capacity, Duration duration) {
  std::vector<Duration> ends;
  bool in_gap = false;
  for (Duration t{0}; t < duration; t = capacity.NextChange(t)) {
    const bool now = capacity.RateAt(t) <= kGapRate;
    if (in_gap && !now) ends.push_back(t);
    in_gap = now;
  }
  return ends;
}

std::vector<double> RecoveryAfterGaps(const Capacity& capacity,
                                      const std::vector<SentPacket>& packets,
                                      const RecoveryConfig& config) {
  const SentBits sent(packets, config.duration);
  const auto back = [&](Duration t) {
    const double usable = std::min(capacity.Between(t, t + kWindow).bits(),
                                   config.source_max.bits_per_second() * Seconds(kWindow));
    return sent.In(t, kWindow) >= config.share * usable;
  };
  std::vector<double> times;
  for (const Duration end : EndsOfGaps(capacity, config.duration)) {
    Duration until = std::min(config.duration, end + kLongest);
    for (Duration t = end; t < until; t += kGrain)
      if (capacity.RateAt(t) <= kGapRate) until = t;
    if (until - end < 2 * kWindow) continue;
    Duration t = end;
    while (t + kWindow < until && !back(t)) t += kGrain;
    times.push_back(Seconds(t - end));
  }
  return times;
}

}  // namespace lidar::link
