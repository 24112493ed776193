// SPDX-License-Identifier: LGPL-2.1-or-later
// Poses over time, and the text files for them.
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

/// Writes a line of a TUM file: "seconds tx ty tz qx qy qz qw".
void WriteTumLine(std::ostream& out, const StampedPose& pose);
/// Writes a line of a KITTI file: the first three rows of the 4x4 matrix, without a time.
void WriteKittiLine(std::ostream& out, const Pose& pose);

/// Reads "tx ty tz qx qy qz qw"; returns nothing for other text.
std::optional<Pose> ParsePose(const std::string& text);
/// Reads "vx vy vz wx wy wz"; returns nothing for other text.
std::optional<Twist> ParseTwist(const std::string& text);

/// Reads a TUM file (eight columns) or a KITTI file (twelve columns, poses `kitti_period` apart).
/// Lines that begin with # are comments. After an error the result is empty and `error` names the
/// wrong line. A last line without a line end is dropped: its writer may have stopped in the
/// middle.
Trajectory ReadTrajectory(std::istream& in, Duration kitti_period, std::string* error);

/// Interpolates the pose at `t`. Before the first pose it returns the first, after the last the
/// last. The trajectory must not be empty.
Pose InterpolateAt(const Trajectory& trajectory, Time t);

}  // namespace lidar::odometry
