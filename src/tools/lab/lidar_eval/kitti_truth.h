// SPDX-License-Identifier: LGPL-2.1-or-later
// The true trajectory of the sensor in a KITTI sequence.
#pragma once
#include <string>

#include "src/odometry/trajectory.h"

namespace lidar::tools {

/// Reads the poses of poses.txt, which are those of a camera, and turns them into the sensor's with
/// `Tr` of calib.txt; without calib.txt they are the sensor's. Empty without poses.txt. Throws
/// std::runtime_error.
odometry::Trajectory ReadKittiTruth(const std::string& folder);

}  // namespace lidar::tools
