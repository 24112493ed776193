// SPDX-License-Identifier: LGPL-2.1-or-later
// Simulates one direction of a path: random loss, then a queue before a link of changing capacity,
// then propagation.
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
  Duration low = std::chrono::milliseconds{2};    // ramp: no marks below this delay
  Duration high = std::chrono::milliseconds{10};  // ramp: all marked above; step: threshold
  Pi2Config pi2;  // for kPi2 and kDualPi2, which ignore the fields above
};

/// A limit in bytes, in time, or in both. The current capacity converts the time to bytes.
struct QueueLimit {
  DataSize bytes = DataSize::Infinite();
  Duration time = Duration::max();
};

struct BottleneckConfig {
  Time origin;  // time 0 of `capacity`
  Capacity capacity = Capacity::Constant(DataRate::Infinite());
  QueueLimit limit;
  AqmConfig aqm;
  double loss = 0;    // probability that a packet is lost before the queue
  Duration delay{0};  // propagation delay
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
  DataSize delivered_size;  // without duplicates
};

/// The times that are passed to the methods must not decrease.
class Bottleneck {
 public:
  explicit Bottleneck(const BottleneckConfig& config);

  void Enqueue(Time now, const Packet& packet);
  /// Returns the time at which Deliver() must be called next, or Time::max() if no packet is in
  /// flight.
  Time NextEventTime() const;
  /// Returns the packets that have arrived or were dropped up to `now`, in the order of these
  /// times.
  std::vector<Outcome> Deliver(Time now);

  DataSize queued() const { return queue_->size(); }
  /// Deliver() updates the counts.
  const BottleneckStats& stats() const { return stats_; }

 private:
  struct Pending {
    Outcome outcome;
    std::uint64_t order;  // order of packets with equal times
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
  Time free_at_;  // time at which the transmitter becomes free
  std::priority_queue<Pending, std::vector<Pending>, Later> pending_;
  std::uint64_t order_ = 0;
  BottleneckStats stats_;
};

}  // namespace lidar::link
