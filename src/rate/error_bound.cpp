// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/error_bound.h"

#include <algorithm>
#include <cmath>

namespace lidar::rate {
namespace {

const double kHalfDiagonal = std::sqrt(3.0) / 2;
// Mean distance from the middle of a unit cube to its points.
constexpr double kMeanInCube = 0.480296;
// The finest grid of a sensor whose resolution nobody told: 1 mm of error, as good as any LiDAR.
constexpr double kFinestXyzStep = 0.001;
constexpr double kFinestStepAtAll = 1e-6;
// Steps of ranges are multiples of a unit by this.
constexpr double kStepsPerUnit = 256;

/// Sum of |k - (n - 1) / 2| over the n values of a bin.
double SumInBin(double n) { return std::fmod(n, 2) > 0.5 ? (n * n - 1) / 4 : n * n / 4; }

}  // namespace

double ResidualModel::MaxError(double step_m) const {
  if (geometry_ == Geometry::kXyz) return step_m * kHalfDiagonal;
  // Twice the error in millimetres is a whole number, and a half is rounded up.
  return 1e-3 * std::ceil((LargerBins(step_m) - 1) * unit_mm_ / 2 - 1e-6);
}

double ResidualModel::LargerBins(double step_m) const {
  return std::max(1.0, std::ceil(step_m / unit() - 1e-6));
}

double ResidualModel::MeanError(double step_m) const {
  if (geometry_ == Geometry::kXyz) return step_m * kMeanInCube;
  const double n = LargerBins(step_m);
  const double units = std::max(1.0, step_m / unit());  // a bin on average
  const double larger = units - (n - 1);                // part of the bins
  return unit() * (larger * SumInBin(n) + (1 - larger) * SumInBin(n - 1)) / units;
}

double ResidualModel::CoarsestStep(double error_m) const {
  const double error = std::max(error_m, 0.0);
  if (geometry_ == Geometry::kXyz) return std::max(error / kHalfDiagonal, kFinestStepAtAll);
  // Errors are whole millimetres. The little more lets 20 mm, which is no exact double, be that.
  const double whole_mm = std::floor(1e3 * error + 1e-9);
  return unit() * (std::floor(2 * whole_mm / unit_mm_) + 1);
}

double ResidualModel::FinestStep() const {
  return geometry_ == Geometry::kRange ? unit() : kFinestXyzStep;
}

double ResidualModel::step_unit() const { return unit() / kStepsPerUnit; }

}  // namespace lidar::rate
