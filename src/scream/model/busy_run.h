// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension capacity: measures the link's capacity by the spacing of packets that waited in its
// queue.
#pragma once
#include <algorithm>
#include <deque>
#include <limits>
#include <optional>

#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::scream {

/// The times between packets that all waited in the bottleneck's queue. The longest of these times
/// is left out, because a link that was interrupted for a moment is not slower.
class BusySpacing {
 public:
  /// Adds a packet. `arrived` is the time between the arrivals of the previous packet and this one,
  /// and `left` is the time between their departures.
  void Add(Duration arrived, Duration left, DataSize size) {
    all_ = {all_.arrived + arrived, all_.left + left, all_.size + size};
    if (arrived > pause_.arrived) pause_ = {arrived, left, size};
  }
  Duration span() const { return all_.arrived; }
  Duration arrived() const { return all_.arrived - pause_.arrived; }
  Duration left() const { return all_.left - pause_.left; }
  /// Returns the rate of the packets, or nothing if they arrived within less than `least`. Arrival
  /// times are too coarse for a shorter measurement.
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

/// Measures the link's capacity from packets that all waited in the bottleneck's queue. The link is
/// never idle between these packets. Their size divided by their arrival time is therefore the
/// capacity, at any rate of the sender. The packets after the last hole show the current capacity.
/// A hole is a time in which the link carried almost nothing although packets waited.
class BusyRun {
 public:
  struct Arrival {
    Time sent{};
    Time time{};
    DataSize size;
    Duration qdelay{0};
    bool busy = false;  ///< the packet was marked or met a queue
    bool marked = false;
  };

  /// Adds an acknowledged packet. Returns true if there was a hole before its arrival.
  bool Add(Arrival a) {
    const bool hole = last_ && std::min(a.time - last_->time, a.qdelay) > kHole;
    const bool back = last_ && a.time < last_->time;
    if (!a.busy || back) EndRun();
    if (!a.busy || back || hole) latest_.clear();
    if (a.busy) {
      // The last packet of the previous report may have overtaken this packet.
      if (packets_ > 0) a.sent = std::max(a.sent, last_->sent);
      if (packets_ > 0) spacing_.Add(a.time - last_->time, a.sent - last_->sent, a.size);
      ++packets_;
      marked_ += a.marked ? 1 : 0;
      latest_.push_back(a);
      if (latest_.size() > kLatest) latest_.pop_front();
    }
    last_ = a;
    return hole;
  }
  void Reset() { *this = BusyRun(); }
  /// Ends the run, because the time between the last packet and the next one is unknown. A hole is
  /// still detected.
  void EndRun() {
    spacing_ = BusySpacing();
    packets_ = marked_ = 0;
  }

  int packets() const { return packets_; }
  int marked() const { return marked_; }
  Duration span() const { return spacing_.span(); }
  /// Returns the current capacity, or nothing if there are too few packets after the last hole.
  std::optional<DataRate> latest_capacity() const {
    BusySpacing spacing;
    for (std::size_t i = 1; i < latest_.size(); ++i)
      spacing.Add(latest_[i].time - latest_[i - 1].time, Duration{0}, latest_[i].size);
    return latest_.size() < kMinLatest ? std::nullopt : spacing.rate(kMinLatestBusy);
  }
  /// Returns the capacity measured by the whole run, or the current capacity if that is larger.
  /// Returns nothing if the run is too short.
  std::optional<DataRate> capacity() const {
    const auto whole = packets_ < kMinPackets ? std::nullopt : spacing_.rate(kMinBusy);
    return whole ? std::max(whole, latest_capacity()) : std::nullopt;
  }
  /// Returns how much the queueing delay has grown from the first packet to the last, as a multiple
  /// of the mean time between departures. The delay grows if the link is slower than the sender,
  /// because the packets then arrive further apart than they left. The longest pause does not
  /// count. Returns infinity if all packets left at once.
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
  static constexpr std::size_t kLatest = 40;
  static constexpr std::size_t kMinLatest = 6;
  static constexpr Duration kMinLatestBusy = std::chrono::milliseconds(5);
  static constexpr Duration kHole = std::chrono::milliseconds(30);
  std::optional<Arrival> last_;
  BusySpacing spacing_;
  int packets_ = 0;
  int marked_ = 0;
  std::deque<Arrival> latest_;
};

}  // namespace lidar::scream
