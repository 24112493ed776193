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
  /// The time that is measured. Flows may start before it.
  Duration from{0}, until{0};
  /// Our flows whose media packets pass through link 0. Their rates are compared.
  std::vector<int> forward = {0};
};

/// Returns the cases of RFC 8867, sections 5 and 6.
std::vector<RmcatCase> WiredCases(const Parameters& parameters);
/// Returns the cases of RFC 8869, sections 3 and 4.
std::vector<RmcatCase> WirelessCases(const Parameters& parameters);

/// Returns a flow of video with 30 frames per second, whose sizes vary.
FlowConfig RmcatVideo(const Parameters& parameters, Duration start = {}, double max_mbps = 1.5);

struct RmcatMetrics {
  double utilisation = 0;  ///< relative to what link 0 can carry and its flows can use
  double media_mbps = 0;   ///< mean rate of the forward flows
  double variation = 0;  ///< standard deviation of a flow's rate over 200 ms, relative to its mean
  double jain = 1;       ///< of the forward flows
  Percentiles queue_ms;  ///< of the forward flows' packets
  Percentiles frame_ms;  ///< from a frame's creation to the arrival of its last packet
  double loss = 0;       ///< of all media packets
  double dropped = 0;    ///< fraction of all frames that senders dropped
  double feedback = 0;   ///< bytes of reports relative to bytes of media
  double others_mbps = 0;  ///< mean rate of the other flows while they run
  double file_s = 0;       ///< mean time of a file of the other flows
  /// The delivered bytes of a sender's first stream, relative to those of its second stream.
  std::optional<double> stream_ratio;
};

RmcatMetrics Measure(const RmcatCase& rmcat, const SimulationResult& result);

}  // namespace lidar::scream::test
