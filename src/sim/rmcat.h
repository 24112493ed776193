// SPDX-License-Identifier: LGPL-2.1-or-later
// The test cases of RFC 8867 and RFC 8869 for interactive media, with the metrics of RFC 8868.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "src/sim/simulation.h"

namespace lidar::scream::test {

struct RmcatCase {
  std::string name;     ///< "rfc8867_5.1_variable_capacity"
  std::string section;  ///< "RFC 8867, 5.1"
  std::string description;
  SimulationConfig config;
  /// The measured time. Flows may join before it.
  Duration from{0}, until{0};
  /// Our flows whose media pass link 0. Their shares are compared.
  std::vector<int> forward = {0};
};

/// RFC 8867, sections 5 and 6.
std::vector<RmcatCase> WiredCases(const Parameters& parameters);
/// RFC 8869, sections 3 and 4.
std::vector<RmcatCase> WirelessCases(const Parameters& parameters);

/// A video of 30 frames a second whose sizes vary.
FlowConfig RmcatVideo(const Parameters& parameters, Duration start = {}, double max_mbps = 1.5);

struct RmcatMetrics {
  double utilisation = 0;  ///< relative to what link 0 carries and its flows can use
  double media_mbps = 0;   ///< mean of the forward flows
  double variation = 0;  ///< standard deviation of a flow's rate in 200 ms over its mean, averaged
  double jain = 1;       ///< of the forward flows
  Percentiles queue_ms;  ///< of the forward flows' packets
  Percentiles frame_ms;  ///< creation to last packet
  double loss = 0;       ///< of all media packets
  double dropped = 0;    ///< part of all frames that senders dropped
  double feedback = 0;   ///< size of reports relative to media
  double others_mbps = 0;  ///< mean of the other flows while they run
  double file_s = 0;       ///< mean time of a file of the other flows
  /// Delivered bytes of a sender's first stream, relative to its second.
  std::optional<double> stream_ratio;
};

RmcatMetrics Measure(const RmcatCase& rmcat, const SimulationResult& result);

}  // namespace lidar::scream::test
