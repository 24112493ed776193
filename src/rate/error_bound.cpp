// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/error_bound.h"

#include <algorithm>
#include <cmath>

#include "src/cloud/xyz_grid.h"

namespace lidar::rate {
namespace {

// The mean distance from the middle of a unit cube to its points.
constexpr double kMeanInCube = 0.480296;
// The finest step if the sensor's resolution is unknown. No LiDAR is more accurate.
constexpr double kFinestXyzStep = 0.001;
constexpr double kFinestStepAtAll = 1e-6;

/// Returns the sum of |k - (n - 1) / 2| over the n values k of a bin, which begin at 0.
double SumInBin(double n) { return std::fmod(n, 2) > 0.5 ? (n * n - 1) / 4 : n * n / 4; }

}  // namespace

double ErrorBound::MaxError(double step_m) const {
  if (geometry_ == Geometry::kXyz) return step_m * kXyzErrorPerStep;
  return RangeGrid::ForStep(step_m, unit_mm_).error_m();
}

double ErrorBound::MeanError(double step_m) const {
  if (geometry_ == Geometry::kXyz) return step_m * kMeanInCube;
  const RangeGrid grid = RangeGrid::ForStep(step_m, unit_mm_);
  const double n = grid.largest_bin();
  const double units = grid.step_m() / unit();  // units in a bin, on average
  const double larger = units - (n - 1);        // share of the larger bins
  return unit() * (larger * SumInBin(n) + (1 - larger) * SumInBin(n - 1)) / units;
}

double ErrorBound::CoarsestStep(double error_m) const {
  if (geometry_ == Geometry::kXyz) return std::max(error_m / kXyzErrorPerStep, kFinestStepAtAll);
  return RangeGrid::ForError(error_m, unit_mm_).step_m();
}

double ErrorBound::FinestStep() const {
  return geometry_ == Geometry::kRange ? unit() : kFinestXyzStep;
}

double ErrorBound::step_unit() const { return unit() / RangeGrid::kParts; }

}  // namespace lidar::rate
