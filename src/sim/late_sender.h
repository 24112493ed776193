// SPDX-License-Identifier: LGPL-2.1-or-later
// A yardstick for adaptive senders: a sender that learns the link's capacity one round trip late.
#pragma once
#include <cstdint>

#include "src/base/time.h"
#include "src/base/units.h"
#include "src/link/capacity.h"

namespace lidar::loop {

/// The sender and its source. The rate of a slice is `share` of the known capacity, between `min`
/// and `max`.
struct LateSenderConfig {
  double share = 0.8;  ///< of the capacity; 0: does not adapt, all slices have the lowest rate
  DataRate min;        // lowest rate of the source
  DataRate max;
  Duration duration = std::chrono::seconds{60};
  Duration rtt = std::chrono::milliseconds{40};
  /// A slice that has waited longer at the sender is dropped.
  Duration max_queue_delay = std::chrono::milliseconds{200};
  /// A scan is in time if all of its slices arrive within this time.
  Duration max_age = std::chrono::milliseconds{200};
  std::uint32_t slices_per_scan = 8;
  double scans_per_second = 10;
};

struct LateSenderReport {
  std::uint64_t complete = 0;
  std::uint64_t in_time = 0;
  double utilisation = 0;   // relative to what the link can carry and the source can use
  double queue_p95_ms = 0;  // of the network's queue
};

/// Simulates this sender. Its window is the known rate times the round trip, so that no more data
/// are in flight than fill the link when a gap begins.
LateSenderReport SendLate(const link::Capacity& capacity, const LateSenderConfig& config);

}  // namespace lidar::loop
