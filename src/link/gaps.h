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

/// Returns, for each gap, the time from its end until the sender has recovered [s]. A sender has
/// recovered when it uses, for a tenth of a second, the fraction `share` of what the link can carry
/// and the source can use. The time is at most 5 s, and is cut off at the next gap. A gap is left
/// out if the next gap begins within 0.2 s.
std::vector<double> RecoveryAfterGaps(const Capacity& capacity,
                                      const std::vector<SentPacket>& packets,
                                      const RecoveryConfig& config);

}  // namespace lidar::link
