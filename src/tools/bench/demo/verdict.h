// SPDX-License-Identifier: LGPL-2.1-or-later
// Judges how useful a run was, relative to the capacity of its links.
#pragma once
#include <string>
#include <vector>

#include "src/link/oracle.h"
#include "src/tools/bench/demo/measurements.h"

namespace lidar::demo {

/// Returns the number of bits on the wire for each bit of the encoder's output, not counting copies
/// of packets. Returns 1 if there was no output.
double WireShare(const Measurements& m);
/// Returns the scans that a sender with full knowledge of the links could deliver, if its media had
/// the bitrate `media_bps`.
link::OracleResult AskOracle(const Measurements& m, double media_bps);

struct Verdict {
  enum class Level { kUseful, kReduced, kPoor };
  Level level = Level::kUseful;
  std::string text;
  std::vector<std::string> hints;  // causes, and suggestions
};
Verdict Judge(const Measurements& m);

}  // namespace lidar::demo
