// SPDX-License-Identifier: LGPL-2.1-or-later
// Decides how to degrade scans if the target is below what the error bound needs. Intensity bits
// are reduced first, then scans or points are left out.
#pragma once
#include <vector>

#include "src/rate/demand_table.h"

namespace lidar::rate {

enum class DegradationPreference {
  kMaintainAccuracy,   // whole scans are skipped
  kMaintainFramerate,  // points of every scan are thinned
  kBalanced,           // both by the same factor
};

/// The decision for all slices of a scan.
struct ScanPlan {
  bool skip = false;
  /// True if the budget is below what the error bound needs. The coarsest step is then used, even
  /// if bytes are left over from earlier scans.
  bool degraded = false;
  double keep_fraction = 1;  // of the returns
  unsigned intensity_bits = 0;
};

struct ScanPlanInputs {
  Demand needed;          // of the whole scan
  double budget = 0;      // bytes that the target gives one scan
  double saved = 0;       // bytes left over from earlier scans; negative: a debt
  bool measured = false;  // a slice has been encoded, so `needed` is known
  unsigned intensity_bits = 0;
  unsigned min_intensity_bits = 0;
  unsigned last_intensity_bits = 0;
};

ScanPlan PlanScan(const ScanPlanInputs& inputs, DegradationPreference preference);

/// Returns for each of `count` rows (beams, columns or points) whether a thinned slice keeps it. A
/// part of `fraction` is kept, but at least one row. The rows that are kept are evenly distributed,
/// and are the same in each call.
std::vector<bool> ThinningPattern(std::size_t count, double fraction);

}  // namespace lidar::rate
