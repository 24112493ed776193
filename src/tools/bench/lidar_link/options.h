// SPDX-License-Identifier: LGPL-2.1-or-later
// The command line of lidar-link.
#pragma once
#include <string>
#include <vector>

#include "src/base/time.h"
#include "src/link/bottleneck.h"

namespace lidar::tools {

struct LinkOptions {
  std::vector<std::string> listen{"127.0.0.1:5004"};
  std::vector<std::string> forward{"127.0.0.1:5006"};
  link::BottleneckConfig there;  // towards the receiver; its time starts with the first packet
  link::BottleneckConfig back;
  bool origin_at_start = false;
  bool bleach = false;
  std::int64_t overhead_bytes = 28;
  std::string log;
  std::string summary;
  Duration duration = Duration::max();
  Duration interval = std::chrono::seconds{1};
  bool json_lines = false;
  bool quiet = false;
};

/// Parses the command line. Exits the program after --help, and with code 2 if the options are
/// wrong.
LinkOptions ParseLinkOptions(int argc, char** argv);

}  // namespace lidar::tools
