// SPDX-License-Identifier: LGPL-2.1-or-later
// Poses over time, and the text files that the field keeps them in.
#pragma once
#include <istream>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "src/base/time.h"
#include "src/odometry/pose.h"

namespace lidar::odometry {

struct StampedPose {
  Time time{};
  Pose pose;
};
using Trajectory = std::vector<StampedPose>;  // ascending in time

/// One line of a TUM file: "seconds tx ty tz qx qy qz qw".
void WriteTumLine(std::ostream& out, const StampedPose& pose);
/// One line of a KITTI file: the first three rows of the 4x4 matrix. It has no time.
void WriteKittiLine(std::ostream& out, const Pose& pose);

/// Reads "tx ty tz qx qy qz qw"; none for any other text.
std::optional<Pose> ParsePose(const std::string& text);
/// Reads "vx vy vz wx wy wz"; none for any other text.
std::optional<Twist> ParseTwist(const std::string& text);

/// Reads a TUM file (eight columns) or a KITTI file (twelve; its poses are `kitti_period` apart).
/// Lines that begin with # are comments. On an error the result is empty and `error` says which
/// line is wrong. A last line without its end is left out: a writer may have been stopped there.
Trajectory ReadTrajectory(std::istream& in, Duration kitti_period, std::string* error);

/// The pose at `t` between the two around it; the first or last one outside of them. The trajectory
/// must not be empty.
Pose InterpolateAt(const Trajectory& trajectory, Time t);

}  // namespace lidar::odometry
