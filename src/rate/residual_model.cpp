// SPDX-License-Identifier: LGPL-2.1-or-later
#include "rate/residual_model.h"

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

}  // namespace

double ResidualModel::MaxError(double step_m) const {
  if (geometry_ == Geometry::kXyz) return step_m * kHalfDiagonal;
  return std::max(0.0, step_m - unit()) / 2;
}

double ResidualModel::MeanError(double step_m) const {
  if (geometry_ == Geometry::kXyz) return step_m * kMeanInCube;
  // Mean of |k - (n - 1) / 2| over the n values of a bin.
  const double n = std::max(1.0, std::round(step_m / unit()));
  return unit() * (std::fmod(n, 2) > 0.5 ? (n * n - 1) / (4 * n) : n / 4);
}

double ResidualModel::CoarsestStep(double error_m) const {
  const double error = std::max(error_m, 0.0);
  if (geometry_ == Geometry::kXyz) return std::max(error / kHalfDiagonal, kFinestStepAtAll);
  // The little more lets 2E that is a whole number in decimal be one in binary.
  return unit() + std::floor(2 * error / step_unit() + 1e-6) * step_unit();
}

double ResidualModel::FinestStep() const {
  return geometry_ == Geometry::kRange ? unit() : kFinestXyzStep;
}

double ResidualModel::step_unit() const { return unit_mm_ % 2 == 0 ? unit() : 2 * unit(); }

}  // namespace lidar::rate
