// SPDX-License-Identifier: LGPL-2.1-or-later
// The rate at which packets that left one behind the other arrived: the link carries that much.
#pragma once
#include <algorithm>
#include <optional>

#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::scream {

/// Unlike ArrivalTrain it asks for no queue, so it is no more than a lower bound of the capacity. A
/// link that jitters cannot show more than was sent.
class BurstRate {
 public:
  struct Packet {
    Time sent{};
    Time arrival{};
    DataSize size;
  };

  /// Returns the rate of a burst that is long enough against the coarse arrival times of reports.
  std::optional<DataRate> Add(const Packet& p) {
    const bool pause = last_ && (p.sent < last_->sent || p.sent - last_->sent > kPause);
    if (!last_ || pause || p.arrival < last_->arrival)
      Begin(p);
    else
      bytes_ += p.size;
    last_ = p;
    const Duration span = std::max(p.sent - first_.sent, p.arrival - first_.arrival);
    if (span < kLong) return std::nullopt;
    const DataSize bytes = bytes_;
    Begin(p);
    return bytes / span;
  }
  void Reset() { last_.reset(); }

 private:
  void Begin(const Packet& p) {
    first_ = p;
    bytes_ = DataSize();
  }
  static constexpr Duration kPause = std::chrono::milliseconds(4);
  static constexpr Duration kLong = std::chrono::milliseconds(5);
  Packet first_;
  std::optional<Packet> last_;
  DataSize bytes_;  // since the first
};

}  // namespace lidar::scream
