// SPDX-License-Identifier: LGPL-2.1-or-later
// The residual error optimizer: the largest distance by which a uniform grid moves a point, and the
// coarsest grid within an error.
#pragma once
#include "src/cloud/coded_geometry.h"
#include "src/cloud/range_grid.h"

namespace lidar::rate {

/// Bounds by construction, without measurement (docs/rate-control.md).
class ErrorBound {
 public:
  static ErrorBound Xyz() { return ErrorBound(Geometry::kXyz, 0); }
  /// `unit_mm`: resolution of the ranges, not 0. The grid is a RangeGrid.
  static ErrorBound Range(unsigned unit_mm) { return ErrorBound(Geometry::kRange, unit_mm); }

  /// Largest distance [m] between a point and its decoded point.
  double MaxError(double step_m) const;
  /// Mean distance [m] between points and decoded points if the points are spread evenly.
  double MeanError(double step_m) const;
  /// The coarsest step [m] whose MaxError is not above `error_m`. Errors below the sensor's
  /// resolution give the finest step.
  double CoarsestStep(double error_m) const;
  /// Finest useful step [m]: finer ones only code digits that the sensor does not have.
  double FinestStep() const;
  /// Steps are FinestStep() plus multiples of this [m]; 0 for xyz: any step. Steps of ranges are
  /// small enough for nearly continuous sizes.
  double step_unit() const;
  Geometry geometry() const { return geometry_; }

 private:
  ErrorBound(Geometry geometry, unsigned unit_mm) : geometry_(geometry), unit_mm_(unit_mm) {}
  double unit() const { return 1e-3 * unit_mm_; }
  Geometry geometry_;
  unsigned unit_mm_;
};

}  // namespace lidar::rate
