// SPDX-License-Identifier: LGPL-2.1-or-later
// Whether a run was of use, beside what its link could have carried.
#pragma once
#include <string>
#include <vector>

#include "src/link/oracle.h"
#include "src/tools/bench/demo/measurements.h"

namespace lidar::demo {

/// Bits on the wire for each bit that the encoder put out; 1 without output.
double WireShare(const Measurements& m);
/// What a sender that knew the link could deliver of scans at this bitrate of media.
link::OracleResult AskOracle(const Measurements& m, double media_bps);

struct Verdict {
  enum class Level { kUseful, kReduced, kPoor };
  Level level = Level::kUseful;
  std::string text;
  std::vector<std::string> hints;  // why, and what to try
};
Verdict Judge(const Measurements& m);

}  // namespace lidar::demo
