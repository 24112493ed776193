// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the true trajectory of the sensor in a KITTI sequence.
#pragma once
#include <string>

#include "src/odometry/trajectory.h"

namespace lidar::tools {

/// Reads poses.txt. If there is a calib.txt, the poses are those of a camera, and its `Tr` converts
/// them to poses of the sensor. Returns an empty trajectory if there is no poses.txt. Throws
/// std::runtime_error if a file is wrong.
odometry::Trajectory ReadKittiTruth(const std::string& folder);

}  // namespace lidar::tools
