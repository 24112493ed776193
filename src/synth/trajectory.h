// SPDX-License-Identifier: LGPL-2.1-or-later
// The exact motion of a sensor on a car that follows its lane.
#pragma once
#include <memory>

#include "src/base/time.h"
#include "src/synth/geometry.h"

namespace lidar::synth {

/// The centre of a lane that leads over hills and around corners.
class Route {
 public:
  virtual ~Route() = default;
  struct Place {
    double x = 0;
    double y = 0;
    double z = 0;         // height of the road [m]
    double yaw = 0;       // [rad]
    double grade = 0;     // rise of the road per distance
    double bank = 0;      // rise of the road to the left
    double distance = 0;  // distance driven since the start [m]
  };
  /// Returns the position of a car after `seconds`. The car drives at its wanted speed, but slower
  /// in corners.
  virtual Place At(double seconds) const = 0;
};

struct TrajectorySettings {
  double speed_mps = 0;
  double lane_y_m = 0;           // centre of the lane
  double sensor_height_m = 1.9;  // height above the road
  double sway_m = 0.25;          // amplitude of the motion to both sides of the centre
  double bounce = 1;             // factor of the body's motion; 1 on asphalt
  // The route of the lane's centre. If it is empty, the lane leads along x at constant speed.
  std::shared_ptr<const Route> route;
};

/// Computes the pose of the sensor. Sway and bounce depend on the driven distance, so that a sensor
/// on a car that stands does not shake.
class Trajectory {
 public:
  explicit Trajectory(const TrajectorySettings& settings) : settings_(settings) {}
  /// Returns the pose of the sensor frame at the time `t` after the start.
  Pose At(Duration t) const;
  double speed() const { return settings_.speed_mps; }

 private:
  Pose OnRoute(Duration t) const;

  TrajectorySettings settings_;
};

}  // namespace lidar::synth
