// SPDX-License-Identifier: LGPL-2.1-or-later
// A train of packets that left the bottleneck's queue without pause, and the holes between trains.
#pragma once
#include <algorithm>
#include <deque>
#include <optional>

#include "src/base/time.h"
#include "src/base/units.h"
#include "src/scream/model/busy_run.h"

namespace lidar::scream {

/// A hole is a time in which the link stood nearly still while packets waited. The packets after it
/// show the link's present capacity.
class ArrivalTrain {
 public:
  struct Arrival {
    Time time{};
    DataSize size;
    Duration qdelay{0};
    bool waited = false;  ///< it was in the bottleneck's queue
  };

  /// Returns true if the packet came after a hole.
  bool Add(const Arrival& a) {
    const bool hole = last_ && std::min(a.time - last_->time, a.qdelay) > kHole;
    if (hole || !a.waited || (last_ && a.time < last_->time)) train_.clear();
    if (a.waited) train_.push_back(a);
    if (train_.size() > kLongest) train_.pop_front();
    last_ = a;
    return hole;
  }
  void Reset() { *this = ArrivalTrain(); }

  /// Returns the link's capacity, or nothing for a train that is too short.
  std::optional<DataRate> rate() const {
    if (train_.size() < kShortest) return std::nullopt;
    BusySpacing spacing;
    for (std::size_t i = 1; i < train_.size(); ++i)
      spacing.Add(train_[i].time - train_[i - 1].time, Duration{0}, train_[i].size);
    return spacing.rate(kMinSpan);
  }

 private:
  static constexpr Duration kHole = std::chrono::milliseconds(30);
  static constexpr Duration kMinSpan = std::chrono::milliseconds(5);
  static constexpr std::size_t kShortest = 6;
  static constexpr std::size_t kLongest = 40;
  std::deque<Arrival> train_;
  std::optional<Arrival> last_;
};

}  // namespace lidar::scream
