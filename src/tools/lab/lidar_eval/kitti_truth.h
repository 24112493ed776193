// SPDX-License-Identifier: LGPL-2.1-or-later
// The true trajectory of the sensor in a KITTI sequence.
#pragma once
#include <string>

#include "src/odometry/trajectory.h"

namespace lidar::tools {

/// Reads poses.txt. Its poses are those of a camera if there is a calib.txt, and are converted to
/// the sensor's by its `Tr`. Returns an empty trajectory without poses.txt. Throws
/// std::runtime_error.
odometry::Trajectory ReadKittiTruth(const std::string& folder);

}  // namespace lidar::tools
