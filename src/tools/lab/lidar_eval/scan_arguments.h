// SPDX-License-Identifier: LGPL-2.1-or-later
// The arguments of the subcommands slam and to-kitti: a source, and changes to its scans.
#pragma once
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "src/tools/lab/codec_lab/scan_faults.h"
#include "src/tools/lab/lidar_eval/slam_run.h"

namespace lidar::tools {

struct ScanArguments {
  std::string source;
  SourceOptions read;
  ScanFaults faults;
  CodingLoss loss;
};

void AddScanOptions(CLI::App* command, ScanArguments* arguments);
std::unique_ptr<ScanStream> OpenScans(const ScanArguments& arguments);

}  // namespace lidar::tools
