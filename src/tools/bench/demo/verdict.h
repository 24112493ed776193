// SPDX-License-Identifier: LGPL-2.1-or-later
// Judges whether a run was useful, relative to its link's capacity.
#pragma once
#include <string>
#include <vector>

#include "src/link/oracle.h"
#include "src/tools/bench/demo/measurements.h"

namespace lidar::demo {

/// Bits on the wire for each bit that the encoder put out; 1 without output.
double WireShare(const Measurements& m);
/// Returns the scans that a sender with full knowledge of the link could deliver at this bitrate of
/// media.
link::OracleResult AskOracle(const Measurements& m, double media_bps);

struct Verdict {
  enum class Level { kUseful, kReduced, kPoor };
  Level level = Level::kUseful;
  std::string text;
  std::vector<std::string> hints;  // causes, and suggestions
};
Verdict Judge(const Measurements& m);

}  // namespace lidar::demo
