// SPDX-License-Identifier: LGPL-2.1-or-later
// How well, and how soon, the edge knew where the sensor was.
#pragma once
#include <nlohmann/json.hpp>

#include "src/tools/bench/demo/measurements.h"

namespace lidar::demo {

/// False where the programs were built without the odometry.
bool CanFollow();
/// Reads the trajectories of the run and adds "slam" to the summary; writes poses.csv.
void AddSlam(const Measurements& m, const std::string& folder, nlohmann::ordered_json* summary);
void PrintSlam(const nlohmann::ordered_json& summary);

}  // namespace lidar::demo
