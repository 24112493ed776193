// SPDX-License-Identifier: LGPL-2.1-or-later
// Computes the errors and the delays of the poses that the receiver found.
#pragma once
#include <nlohmann/json.hpp>

#include "src/tools/bench/demo/measurements.h"

namespace lidar::demo {

/// Returns true if the programs were built with the odometry.
bool CanFollow();
/// Reads the trajectories of the run, adds "slam" to `summary`, and writes poses.csv.
void AddSlam(const Measurements& m, const std::string& folder, nlohmann::ordered_json* summary);
void PrintSlam(const nlohmann::ordered_json& summary);

}  // namespace lidar::demo
