// SPDX-License-Identifier: LGPL-2.1-or-later
// Errors and delays of the poses that the edge found.
#pragma once
#include <nlohmann/json.hpp>

#include "src/tools/bench/demo/measurements.h"

namespace lidar::demo {

/// Returns false if the programs were built without the odometry.
bool CanFollow();
/// Reads the trajectories of the run and adds "slam" to the summary; writes poses.csv.
void AddSlam(const Measurements& m, const std::string& folder, nlohmann::ordered_json* summary);
void PrintSlam(const nlohmann::ordered_json& summary);

}  // namespace lidar::demo
