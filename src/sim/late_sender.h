// SPDX-License-Identifier: LGPL-2.1-or-later
// A yardstick for adaptive senders: a sender that gets the link's capacity one round trip late.
#pragma once
#include <cstdint>

#include "src/base/time.h"
#include "src/base/units.h"
#include "src/link/capacity.h"

namespace lidar::loop {

/// Each slice is a share of the known capacity, within the source's limits.
struct LateSenderConfig {
  double share = 0.8;  ///< 0: does not adapt, all slices have the lowest rate
  DataRate min;        // rates of the source
  DataRate max;
  Duration duration = std::chrono::seconds{60};
  Duration rtt = std::chrono::milliseconds{40};
  /// A slice that waits longer at the sender is dropped.
  Duration max_queue_delay = std::chrono::milliseconds{200};
  /// A scan is in time if all of its slices arrive within this.
  Duration max_age = std::chrono::milliseconds{200};
  std::uint32_t slices_per_scan = 8;
  double scans_per_second = 10;
};

struct LateSenderReport {
  std::uint64_t complete = 0;
  std::uint64_t in_time = 0;
  double utilisation = 0;   // relative to what the link carries and the source uses at most
  double queue_p95_ms = 0;  // of the network's queue
};

/// The window is the known rate times the round trip. So when a gap begins, no more data are in
/// flight than fill the link.
LateSenderReport SendLate(const link::Capacity& capacity, const LateSenderConfig& config);

}  // namespace lidar::loop
