// SPDX-License-Identifier: LGPL-2.1-or-later
// The true way of the sensor in a sequence of KITTI's.
#pragma once
#include <string>

#include "src/odometry/trajectory.h"

namespace lidar::tools {

/// Of poses.txt, which are those of a camera, with `Tr` of calib.txt from the sensor to it; without
/// calib.txt they are the sensor's. Empty where there is no poses.txt. Throws std::runtime_error.
odometry::Trajectory ReadKittiTruth(const std::string& folder);

}  // namespace lidar::tools
