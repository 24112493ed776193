// SPDX-License-Identifier: LGPL-2.1-or-later
// The subcommands of lidar-eval. Each function adds a subcommand and its options to the program.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace lidar::tools {

void AddBoundsCommand(CLI::App* app);
void AddRateDistortionCommand(CLI::App* app);
void AddCloudsCommand(CLI::App* app);
void AddStaticCommand(CLI::App* app);
void AddTrackCommand(CLI::App* app);
void AddPredictCommand(CLI::App* app);
void AddToPcapCommand(CLI::App* app);
// The following subcommands exist only in builds with odometry.
void AddSlamCommand(CLI::App* app);
void AddAteCommand(CLI::App* app);
void AddToKittiCommand(CLI::App* app);

/// Adds an option for a list of error bounds [m] to a subcommand.
inline void AddErrorBounds(CLI::App* command, const std::string& name, std::vector<double>* bounds,
                           const std::string& about) {
  command->add_option(name, *bounds, about)->delimiter(',')->check(CLI::Range(1e-4, 10.0));
}

}  // namespace lidar::tools
