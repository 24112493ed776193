// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes the files of a run: tables in CSV format, and plots. Prints the summary as a table.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "src/tools/bench/demo/measurements.h"

namespace lidar::demo {

/// Writes slices.csv, with a row for each slice, and timeline.csv, with a row for each tenth of a
/// second.
void WriteTables(const Measurements& m, const std::string& folder);
/// Removes the files of an earlier run, so that they cannot be mistaken for files of this run.
void RemoveReport(const std::string& folder);
/// Runs gnuplot to draw the tables. If that fails, prints a message to standard error and returns
/// false.
bool DrawPlots(const Measurements& m, const std::string& folder);
void PrintTable(const nlohmann::ordered_json& summary);

}  // namespace lidar::demo
