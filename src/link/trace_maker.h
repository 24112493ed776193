// SPDX-License-Identifier: LGPL-2.1-or-later
// Makes capacity traces: drives through a cellular network, and links with regular gaps.
#pragma once
#include <cstdint>
#include <string>

#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::link {

/// A drive like measured 5G uplinks. The rate changes by a factor of two or three within seconds,
/// handovers are gaps of 0.1 to 2 s, and at the edge of a cell the rate fades and gaps come close
/// together.
struct DriveTraceConfig {
  std::uint64_t seed = 1;
  Duration duration = std::chrono::seconds{180};
  DataRate mean = DataRate::BitsPerSecond(8e6);     // approximate, with gaps
  DataRate in_gaps = DataRate::BitsPerSecond(2e5);  // nearly nothing
};
/// Returns text for Capacity::ParseTrace(): the rate of each tenth of a second, the same on every
/// machine.
std::string MakeDriveTrace(const DriveTraceConfig& config);

struct GapTraceConfig {
  DataRate rate = DataRate::BitsPerSecond(8e6);
  DataRate in_gaps = DataRate::BitsPerSecond(2e5);
  Duration gap = std::chrono::milliseconds{100};
  Duration every = std::chrono::seconds{2};  // period; each ends with its gap
  Duration duration = std::chrono::seconds{180};
};
std::string MakeGapTrace(const GapTraceConfig& config);

}  // namespace lidar::link
