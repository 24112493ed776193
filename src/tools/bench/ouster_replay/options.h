// SPDX-License-Identifier: LGPL-2.1-or-later
// The command line of ouster-replay.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "src/tools/bench/ouster_replay/synth_stream.h"

namespace lidar::tools {

struct ReplayOptions {
  std::string pcap;  // empty: synthesise the packets
  std::string metadata;
  bool once = false;
  double speed = 1;
  SynthOptions synth;
  SynthFormat format;
  std::string destination = "127.0.0.1";
  std::string source;           // address to send from; empty: any
  std::string multicast_iface;  // empty: the kernel's choice
  std::uint64_t serial = 0;     // 0: as in the metadata
  int lidar_port = 0;           // 0: as in the metadata
  int imu_port = 0;
  std::string timestamp_mode;  // empty: as in the metadata
  bool http = true;
  std::string http_address = "127.0.0.1";
  int http_port = 8080;
  bool old_firmware = false;
  double boot_s = 0.5;
  double duration_s = 0;  // 0: until a signal
  std::uint64_t seed = 1;
  nlohmann::json faults = nlohmann::json::object();
  struct Event {
    double at_s = 0;
    nlohmann::json faults;  // as in faults.h
    bool restart = false;
  };
  std::vector<Event> events;  // in order of time
  std::string write_pcap;     // file to write instead of sending packets
  std::string write_metadata;
  int scans = 10;  // number of scans in that file
};

/// Parses the command line. If it is wrong, exits the program with a message.
ReplayOptions ParseReplayOptions(int argc, char** argv);

}  // namespace lidar::tools
