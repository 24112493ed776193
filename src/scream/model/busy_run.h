// SPDX-License-Identifier: LGPL-2.1-or-later
// Beyond the draft: measures the capacity of a busy link from the spacing of arrivals.
#pragma once
#include <algorithm>
#include <limits>
#include <optional>

#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::scream {

/// Times between packets that all waited in the bottleneck's queue, without the longest pause: a
/// link that stood still for a moment is not slower.
class BusySpacing {
 public:
  /// `arrived` and `left`: time since the packet before.
  void Add(Duration arrived, Duration left, DataSize size) {
    all_ = {all_.arrived + arrived, all_.left + left, all_.size + size};
    if (arrived > pause_.arrived) pause_ = {arrived, left, size};
  }
  Duration span() const { return all_.arrived; }
  Duration arrived() const { return all_.arrived - pause_.arrived; }
  Duration left() const { return all_.left - pause_.left; }
  /// Returns nothing for less than `least`, as arrival times of reports are coarse.
  std::optional<DataRate> rate(Duration least) const {
    if (arrived() < least) return std::nullopt;
    return (all_.size - pause_.size) / arrived();
  }

 private:
  struct Step {
    Duration arrived{0}, left{0};
    DataSize size;
  };
  Step all_;    // sum of all steps
  Step pause_;  // longest step
};

/// The link is never idle between packets that all waited in the bottleneck's queue. Their bytes
/// over their arrival time are its capacity, at any rate of the sender.
class BusyRun {
 public:
  struct Arrival {
    Time sent{};
    Time time{};
    DataSize size;
    bool busy = false;  ///< it waited: was marked, or had a queue before it
    bool marked = false;
  };

  void Add(const Arrival& a) {
    if (!a.busy || (last_ && a.time < last_->time)) {
      Reset();
      return;
    }
    ++packets_;
    marked_ += a.marked ? 1 : 0;
    // A packet of the last report may have overtaken this one.
    const Time sent = last_ ? std::max(a.sent, last_->sent) : a.sent;
    if (last_) spacing_.Add(a.time - last_->time, sent - last_->sent, a.size);
    last_ = a;
    last_->sent = sent;
  }
  void Reset() { *this = BusyRun(); }

  int packets() const { return packets_; }
  int marked() const { return marked_; }
  Duration span() const { return spacing_.span(); }
  /// Returns nothing for a run that is too short.
  std::optional<DataRate> capacity() const {
    return packets_ < kMinPackets ? std::nullopt : spacing_.rate(kMinBusy);
  }
  /// Returns the growth of the queueing delay from the first packet to the last, in gaps between
  /// departures. A link that is slower than the sender spreads the packets. The longest pause does
  /// not count. Infinite if all packets left at once.
  double growth() const {
    const Duration arrived = spacing_.arrived();
    const Duration left = spacing_.left();
    if (packets_ <= 2 || arrived <= left) return 0;
    if (left <= Duration{0}) return std::numeric_limits<double>::infinity();
    return Seconds(arrived - left) / Seconds(left) * (packets_ - 2);
  }

 private:
  static constexpr int kMinPackets = 5;
  static constexpr Duration kMinBusy = std::chrono::milliseconds(7);
  std::optional<Arrival> last_;
  BusySpacing spacing_;
  int packets_ = 0;
  int marked_ = 0;
};

}  // namespace lidar::scream
