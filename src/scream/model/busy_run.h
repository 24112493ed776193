// SPDX-License-Identifier: LGPL-2.1-or-later
// Beyond the draft: the capacity of a link that is visibly busy, from the spacing of arrivals.
#pragma once
#include <optional>

#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::scream {

/// While each packet waited in the bottleneck's queue, the link was never idle between them: bytes
/// over arrival time is its capacity, whatever the sender's rate.
class BusyRun {
 public:
  struct Arrival {
    Time time{};
    DataSize size;
    bool busy = false;  ///< it had to wait: marked, or behind a queue
    bool marked = false;
  };

  void Add(const Arrival& a) {
    if (!a.busy || (start_ && a.time < last_)) {
      Reset();
      return;
    }
    ++packets_;
    marked_ += a.marked ? 1 : 0;
    if (!start_) {
      start_ = a.time;
    } else {
      bytes_ += a.size;
      if (a.time - last_ > pause_) {
        pause_ = a.time - last_;
        after_pause_ = a.size;
      }
    }
    last_ = a.time;
  }
  void Reset() { *this = BusyRun(); }

  int packets() const { return packets_; }
  int marked() const { return marked_; }
  Duration span() const { return start_ ? last_ - *start_ : Duration{0}; }
  /// Without the longest pause: a link that stood still for a moment has not become slower. None
  /// for a run too short against the coarse arrival times of reports.
  std::optional<DataRate> capacity() const {
    const Duration busy = span() - pause_;
    if (packets_ < kMinPackets || busy < kMinBusy) return std::nullopt;
    return (bytes_ - after_pause_) / busy;
  }

 private:
  static constexpr int kMinPackets = 5;
  static constexpr Duration kMinBusy = std::chrono::milliseconds(7);
  std::optional<Time> start_;
  Time last_{};
  DataSize bytes_;
  Duration pause_{0};
  DataSize after_pause_;
  int packets_ = 0;
  int marked_ = 0;
};

}  // namespace lidar::scream
