// SPDX-License-Identifier: LGPL-2.1-or-later
// Faults of a network or a poorer sensor in the scans of a source.
#pragma once
#include <memory>

#include "src/tools/lab/codec_lab/scan_source.h"

namespace lidar::tools {

struct ScanFaults {
  double lost_share = 0;    // of the scans, three at a time
  double gap_s = 0;         // once, ten seconds after the first scan
  unsigned every_beam = 1;  // 2: half of the beams
  unsigned every_scan = 1;  // 5: every fifth scan, 2 of 10 a second
  bool any() const { return lost_share > 0 || gap_s > 0 || every_beam > 1 || every_scan > 1; }
};

/// The remaining scans of `scans`. Deterministic.
std::unique_ptr<ScanStream> WithFaults(std::unique_ptr<ScanStream> scans, const ScanFaults& faults);

}  // namespace lidar::tools
