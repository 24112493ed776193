// SPDX-License-Identifier: LGPL-2.1-or-later
// Removes scans and beams from a source, as a faulty network or a poorer sensor would.
#pragma once
#include <memory>

#include "src/tools/lab/codec_lab/scan_source.h"

namespace lidar::tools {

struct ScanFaults {
  double lost_share = 0;    // share of the scans that are lost, three at a time
  double gap_s = 0;         // duration of a single gap, ten seconds after the first scan
  unsigned every_beam = 1;  // 2: keeps every second beam
  unsigned every_scan = 1;  // 5: keeps every fifth scan
  bool any() const { return lost_share > 0 || gap_s > 0 || every_beam > 1 || every_scan > 1; }
};

/// Returns `scans` without the scans and beams that `faults` removes. Deterministic.
std::unique_ptr<ScanStream> WithFaults(std::unique_ptr<ScanStream> scans, const ScanFaults& faults);

}  // namespace lidar::tools
