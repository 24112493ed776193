// SPDX-License-Identifier: LGPL-2.1-or-later
// Poses over time, and text files with poses.
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
using Trajectory = std::vector<StampedPose>;  // sorted by time

/// Writes a line of a TUM file: "seconds tx ty tz qx qy qz qw".
void WriteTumLine(std::ostream& out, const StampedPose& pose);
/// Writes a line of a KITTI file: the first three rows of the 4x4 matrix. It has no time.
void WriteKittiLine(std::ostream& out, const Pose& pose);

/// Parses "tx ty tz qx qy qz qw". Returns nothing for any other text.
std::optional<Pose> ParsePose(const std::string& text);
/// Parses "vx vy vz wx wy wz". Returns nothing for any other text.
std::optional<Twist> ParseTwist(const std::string& text);

/// Reads a TUM file (eight columns) or a KITTI file (twelve columns, with poses at intervals of
/// `kitti_period`). Lines that begin with # are comments. After an error the result is empty, and
/// `error` names the line. If the last line has no line end and is incomplete, it is ignored,
/// because its writer may have been stopped.
Trajectory ReadTrajectory(std::istream& in, Duration kitti_period, std::string* error);

/// Returns the pose at `t`, interpolated between poses. Returns the first pose for an earlier time,
/// and the last pose for a later time. The trajectory must not be empty.
Pose InterpolateAt(const Trajectory& trajectory, Time t);

}  // namespace lidar::odometry
