// SPDX-License-Identifier: LGPL-2.1-or-later
// The exact motion of the sensor: a car that follows its lane.
#pragma once
#include <memory>

#include "src/base/time.h"
#include "src/synth/geometry.h"

namespace lidar::synth {

/// A lane over hills and around corners.
class Route {
 public:
  virtual ~Route() = default;
  struct Place {
    double x = 0;
    double y = 0;
    double z = 0;         // of the road [m]
    double yaw = 0;       // [rad]
    double grade = 0;     // rise over the distance
    double bank = 0;      // rise to the left
    double distance = 0;  // driven since the start [m]
  };
  /// Returns the place of a car after `seconds` at its wanted speed, or slower in corners.
  virtual Place At(double seconds) const = 0;
};

struct TrajectorySettings {
  double speed_mps = 0;
  double lane_y_m = 0;                 // centre of the lane
  double sensor_height_m = 1.9;        // above the road
  double sway_m = 0.25;                // how far the driver wanders off the centre
  double bounce = 1;                   // body motion, 1 on asphalt
  std::shared_ptr<const Route> route;  // of the lane's centre; empty: along x at constant speed
};

/// Sway and bounce depend on the distance driven, so a standing sensor does not shake.
class Trajectory {
 public:
  explicit Trajectory(const TrajectorySettings& settings) : settings_(settings) {}
  /// Pose of the sensor frame, `t` after the start.
  Pose At(Duration t) const;
  double speed() const { return settings_.speed_mps; }

 private:
  Pose OnRoute(Duration t) const;

  TrajectorySettings settings_;
};

}  // namespace lidar::synth
