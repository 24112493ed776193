// SPDX-License-Identifier: LGPL-2.1-or-later
// The files of a run: tables, CSV files, plots.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "src/tools/bench/demo/measurements.h"

namespace lidar::demo {

/// slices.csv: the life of every slice. timeline.csv: tenths of a second.
void WriteTables(const Measurements& m, const std::string& folder);
/// Removes files of an earlier run, so that they are not taken for this run's.
void RemoveReport(const std::string& folder);
/// Runs gnuplot over the tables. Returns false after a message on standard error if that fails.
bool DrawPlots(const Measurements& m, const std::string& folder);
void PrintTable(const nlohmann::ordered_json& summary);

}  // namespace lidar::demo
