// SPDX-License-Identifier: LGPL-2.1-or-later
// The residual error optimizer. It computes the largest distance by which a uniform grid moves a
// point, and the coarsest grid for an error.
#pragma once
#include "src/cloud/coded_geometry.h"
#include "src/cloud/range_grid.h"

namespace lidar::rate {

/// Computes bounds of errors from the construction of a grid, without measurements
/// (docs/rate-control.md).
class ErrorBound {
 public:
  static ErrorBound Xyz() { return ErrorBound(Geometry::kXyz, 0); }
  /// The grid is a RangeGrid. `unit_mm` is the resolution of the ranges, and is not 0.
  static ErrorBound Range(unsigned unit_mm) { return ErrorBound(Geometry::kRange, unit_mm); }

  /// Returns the largest distance [m] between a point and its decoded point.
  double MaxError(double step_m) const;
  /// Returns the mean distance [m] between points and their decoded points, if the points are
  /// evenly distributed.
  double MeanError(double step_m) const;
  /// Returns the coarsest step [m] whose MaxError() is not above `error_m`. If `error_m` is below
  /// the sensor's resolution, returns the finest step.
  double CoarsestStep(double error_m) const;
  /// Returns the finest useful step [m]. Finer steps would only code digits that the sensor does
  /// not measure.
  double FinestStep() const;
  /// Returns the unit of steps [m]. A step is FinestStep() plus a multiple of the unit. The unit is
  /// 0 for xyz, which can have any step. For ranges it is so small that sizes are nearly
  /// continuous.
  double step_unit() const;
  Geometry geometry() const { return geometry_; }

 private:
  ErrorBound(Geometry geometry, unsigned unit_mm) : geometry_(geometry), unit_mm_(unit_mm) {}
  double unit() const { return 1e-3 * unit_mm_; }
  Geometry geometry_;
  unsigned unit_mm_;
};

}  // namespace lidar::rate
