// SPDX-License-Identifier: LGPL-2.1-or-later
// Gaps of a link's capacity, and how fast a sender recovers from them.
#pragma once
#include <vector>

#include "src/base/time.h"
#include "src/base/units.h"
#include "src/link/capacity.h"

namespace lidar::link {

/// Returns the times at which a gap ends, because the capacity rises again from nearly nothing.
std::vector<Duration> EndsOfGaps(const Capacity& capacity, Duration duration);

/// A packet as it enters the link.
struct SentPacket {
  Duration time{0};
  DataSize size;
};

struct RecoveryConfig {
  Duration duration{0};  // of the measured run
  /// The highest rate of the source.
  DataRate source_max = DataRate::Infinite();
  double share = 0.8;
};

/// Returns, for each gap, the time from its end until the sender has recovered [s]. The usable rate
/// is the capacity of the link, but at most the highest rate of the source. A sender has recovered
/// once it sends at least `share` times the usable rate for a tenth of a second. The time is at
/// most 5 s, and ends at the next gap. A gap is left out if the next gap begins within 0.2 s.
std::vector<double> RecoveryAfterGaps(const Capacity& capacity,
                                      const std::vector<SentPacket>& packets,
                                      const RecoveryConfig& config);

}  // namespace lidar::link
