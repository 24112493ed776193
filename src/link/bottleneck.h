// SPDX-License-Identifier: LGPL-2.1-or-later
// One direction of a path: loss, a queue before a link of changing capacity, propagation.
#pragma once
#include <cstdint>
#include <memory>
#include <queue>
#include <vector>

#include "src/base/time.h"
#include "src/base/units.h"
#include "src/link/capacity.h"
#include "src/link/packet.h"
#include "src/link/path.h"
#include "src/link/pi2.h"
#include "src/link/queue.h"
#include "src/link/random.h"

namespace lidar::link {

struct AqmConfig {
  enum class Kind { kNone, kStep, kRamp, kPi2, kDualPi2 };
  Kind kind = Kind::kNone;
  Duration low = std::chrono::milliseconds{2};    // ramp: no mark below
  Duration high = std::chrono::milliseconds{10};  // ramp: every packet above; step: the threshold
  Pi2Config pi2;  // of kPi2 and kDualPi2, which do not use the fields above
};

/// Either limit, or both; the time is turned into bytes at the capacity of the moment.
struct QueueLimit {
  DataSize bytes = DataSize::Infinite();
  Duration time = Duration::max();
};

struct BottleneckConfig {
  Time origin;  // when the capacity's time is 0
  Capacity capacity = Capacity::Constant(DataRate::Infinite());
  QueueLimit limit;
  AqmConfig aqm;
  double loss = 0;    // probability, drawn as a packet enters
  Duration delay{0};  // propagation
  PathConfig path;
  std::uint64_t seed = 1;
};

struct BottleneckStats {
  std::uint64_t sent = 0;
  std::uint64_t delivered = 0;
  std::uint64_t lost = 0;
  std::uint64_t queue_full = 0;
  std::uint64_t aqm_dropped = 0;
  std::uint64_t marked = 0;
  std::uint64_t duplicated = 0;
  DataSize delivered_size;  // duplicates not counted
};

/// Times passed to calls must not decrease.
class Bottleneck {
 public:
  explicit Bottleneck(const BottleneckConfig& config);

  void Enqueue(Time now, const Packet& packet);
  /// When to call Deliver next; Time::max() where nothing is on the way.
  Time NextEventTime() const;
  /// What has arrived or has been dropped up to `now`, in that order of time.
  std::vector<Outcome> Deliver(Time now);

  DataSize queued() const { return queue_->size(); }
  /// Counted as it happens in Deliver.
  const BottleneckStats& stats() const { return stats_; }

 private:
  struct Pending {
    Outcome outcome;
    std::uint64_t order;  // breaks ties of time
  };
  struct Later {
    bool operator()(const Pending& a, const Pending& b) const;
  };

  bool Full(Time now, DataSize size);
  Time At(Duration capacity_time) const;
  void Advance(Time now);
  void Transmit(const Leaving& leaving, Time now);
  void Conclude(const Outcome& outcome);

  BottleneckConfig config_;
  Random loss_random_;
  std::unique_ptr<Queue> queue_;
  Path path_;
  DataSize limit_ = DataSize::Infinite();
  Time free_at_;  // the transmitter's
  std::priority_queue<Pending, std::vector<Pending>, Later> pending_;
  std::uint64_t order_ = 0;
  BottleneckStats stats_;
};

}  // namespace lidar::link
