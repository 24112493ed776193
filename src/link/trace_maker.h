// SPDX-License-Identifier: LGPL-2.1-or-later
// Generates capacity traces: drives through a cellular network, and links with regular gaps.
#pragma once
#include <cstdint>
#include <string>

#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::link {

/// A drive that resembles measured 5G uplinks. The rate changes by a factor of two or three within
/// seconds. Handovers are gaps of 0.1 to 2 s. At the edge of a cell, the rate is lower and gaps
/// follow each other closely.
struct DriveTraceConfig {
  std::uint64_t seed = 1;
  Duration duration = std::chrono::seconds{180};
  DataRate mean = DataRate::BitsPerSecond(8e6);     // approximate; includes the gaps
  DataRate in_gaps = DataRate::BitsPerSecond(2e5);  // nearly nothing
};
/// Returns a text for Capacity::ParseTrace(), with the rate of each tenth of a second. The text is
/// the same on every machine.
std::string MakeDriveTrace(const DriveTraceConfig& config);

struct GapTraceConfig {
  DataRate rate = DataRate::BitsPerSecond(8e6);
  DataRate in_gaps = DataRate::BitsPerSecond(2e5);
  Duration gap = std::chrono::milliseconds{100};
  Duration every = std::chrono::seconds{2};  // period, which ends with the gap
  Duration duration = std::chrono::seconds{180};
};
std::string MakeGapTrace(const GapTraceConfig& config);

}  // namespace lidar::link
