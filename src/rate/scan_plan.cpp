// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/scan_plan.h"

#include <algorithm>
#include <cmath>

namespace lidar::rate {
namespace {

// A scan is sent even if it lacks up to a tenth of its bytes, because the next scans repay this
// debt by coarser steps.
constexpr double kTolerance = 0.1;
// The least part of a scan that is kept. A cloud that is thinned further would be useless, so scans
// are skipped in addition.
constexpr double kMinKeep = 1.0 / 16;
// The number of intensity bits rises only if there is a margin in the budget. Otherwise it would
// change too often.
constexpr double kRoomToRaise = 0.9;

unsigned IntensityBits(const ScanPlanInputs& in) {
  const unsigned least = std::min(in.min_intensity_bits, in.intensity_bits);
  unsigned bits = in.intensity_bits;
  for (; bits > least; --bits) {
    const double room = bits > in.last_intensity_bits ? kRoomToRaise : 1.0;
    if (in.needed.AtCoarsest(bits) <= room * in.budget) break;
  }
  return bits;
}

}  // namespace

ScanPlan PlanScan(const ScanPlanInputs& in, DegradationPreference preference) {
  ScanPlan plan;
  plan.intensity_bits = IntensityBits(in);
  const double needed = in.needed.AtCoarsest(plan.intensity_bits);
  plan.degraded = needed > in.budget;
  if (!plan.degraded || !in.measured) return plan;
  const double share = in.budget / needed;
  double wanted = 1;  // part of `needed` that a scan sends, unless it is skipped
  if (preference == DegradationPreference::kMaintainFramerate)
    wanted = std::min(1.0, share + std::min(0.0, in.saved / needed));
  else if (preference == DegradationPreference::kBalanced)
    wanted = std::sqrt(share);
  plan.keep_fraction = std::clamp(wanted, kMinKeep, 1.0);
  plan.skip = in.budget + in.saved < plan.keep_fraction * needed * (1 - kTolerance);
  return plan;
}

std::vector<bool> ThinningPattern(std::size_t count, double fraction) {
  std::vector<bool> keep(count, false);
  const double f = std::clamp(fraction, 0.0, 1.0);
  for (std::size_t i = 0; i < count; ++i)
    keep[i] = std::floor(static_cast<double>(i + 1) * f + 1e-9) >
              std::floor(static_cast<double>(i) * f + 1e-9);
  if (count > 0 && std::none_of(keep.begin(), keep.end(), [](bool k) { return k; }))
    keep[count / 2] = true;
  return keep;
}

}  // namespace lidar::rate
