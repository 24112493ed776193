// SPDX-License-Identifier: LGPL-2.1-or-later
// The option --version, the same in every program.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace lidar::tools {

inline void AddVersionFlag(CLI::App* app, const std::string& program) {
  app->set_version_flag("--version", program + " (gst-lidar) " LIDAR_VERSION);
}

}  // namespace lidar::tools
