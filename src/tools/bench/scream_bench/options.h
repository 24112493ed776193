// SPDX-License-Identifier: LGPL-2.1-or-later
// The command line of scream-bench.
#pragma once
#include <cstdint>
#include <string>

#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::tools {

struct BenchTxOptions {
  std::string host;
  std::uint16_t port = 0;
  std::string bind_address;
  std::uint16_t bind_port = 0;
  double fps = 50;
  DataRate init_bitrate = DataRate::BitsPerSecond(1e6);
  DataRate min_bitrate = DataRate::BitsPerSecond(100e3);
  DataRate max_bitrate = DataRate::BitsPerSecond(200e6);
  std::string ecn = "ect1";
  double frame_jitter_percent = 0;
  std::uint32_t mtu = 1200;  // largest RTP packet [bytes]
  std::string log;
};

struct BenchRxOptions {
  std::uint16_t port = 0;
  std::string address;
  std::string feedback;  // HOST:PORT; empty: the source of the media
  std::string num_reports = "count";
  std::string log;
};

struct BenchOptions {
  bool is_sender = true;
  BenchTxOptions tx;
  BenchRxOptions rx;
  Duration duration = Duration::max();
  std::string summary;  // JSON file
};

/// Parses the command line. Exits the program after --help, and with code 2 if the options are
/// wrong.
BenchOptions ParseBenchOptions(int argc, char** argv);

}  // namespace lidar::tools
