// SPDX-License-Identifier: LGPL-2.1-or-later
// The options that say what a program is, the same in every program.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace lidar::tools {

inline void AddVersionFlag(CLI::App* app, const std::string& program) {
  app->set_version_flag("--version", program + " (gst-lidar) " LIDAR_VERSION);
}

// For programs of several commands: all their options at once, of which the man page is made.
inline void AddHelpAllFlag(CLI::App* app) {
  app->set_help_all_flag("--help-all", "Print the help of all subcommands and exit");
}

}  // namespace lidar::tools
