// SPDX-License-Identifier: LGPL-2.1-or-later
// The residual error optimizer: how far a uniform grid can move a point, and the coarsest grid
// that keeps to an error.
#pragma once

namespace lidar::rate {

enum class Geometry { kXyz, kRange };

/// Bounds by construction, not by measurement (docs/rate-control.md).
class ResidualModel {
 public:
  static ResidualModel Xyz() { return ResidualModel(Geometry::kXyz, 0); }
  /// `unit_m`: resolution of the ranges. A bin of n units around its middle value is off by
  /// (n - 1) / 2 units at most.
  static ResidualModel Range(double unit_m) { return ResidualModel(Geometry::kRange, unit_m); }

  /// Largest distance [m] between a point and its decoded point: s sqrt(3)/2 or (s - unit)/2.
  double MaxError(double step_m) const;
  /// Expected distance [m] of points that fall evenly on the grid.
  double MeanError(double step_m) const;
  /// The coarsest step [m] whose MaxError is not above `error_m`; in whole units for ranges.
  /// Errors below the sensor's resolution give the finest step.
  double CoarsestStep(double error_m) const;
  /// A finer step than this [m] only codes digits that the sensor does not have.
  double FinestStep() const;
  /// Steps are whole multiples of this; 0 for xyz.
  double step_unit() const { return unit_m_; }
  Geometry geometry() const { return geometry_; }

 private:
  ResidualModel(Geometry geometry, double unit_m) : geometry_(geometry), unit_m_(unit_m) {}
  Geometry geometry_;
  double unit_m_;
};

}  // namespace lidar::rate
