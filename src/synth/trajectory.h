// SPDX-License-Identifier: LGPL-2.1-or-later
// The exact motion of the sensor: a car that follows its lane.
#pragma once
#include "src/base/time.h"
#include "src/synth/geometry.h"

namespace lidar::synth {

struct TrajectorySettings {
  double speed_mps = 0;
  double lane_y_m = 0;           // centre of the lane
  double sensor_height_m = 1.9;  // above the road
  double sway_m = 0.25;          // how far the driver wanders off the centre
  double bounce = 1;             // body motion, 1 on asphalt
};

/// Everything is a function of the distance driven, so a sensor that stands still does not shake.
class Trajectory {
 public:
  explicit Trajectory(const TrajectorySettings& settings) : settings_(settings) {}
  /// Pose of the sensor frame, `t` after the start.
  Pose At(Duration t) const;
  double speed() const { return settings_.speed_mps; }

 private:
  TrajectorySettings settings_;
};

}  // namespace lidar::synth
