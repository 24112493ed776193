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
  /// What is measured; before it flows may still join.
  Duration from{0}, until{0};
  /// The flows of ours that pass link 0 forward, whose shares are compared.
  std::vector<int> forward = {0};
};

/// RFC 8867, sections 5 and 6.
std::vector<RmcatCase> WiredCases(const Parameters& parameters);
/// RFC 8869, sections 3 and 4.
std::vector<RmcatCase> WirelessCases(const Parameters& parameters);

struct RmcatMetrics {
  double utilisation = 0;  ///< of what link 0 carries and its flows can use
  double media_mbps = 0;   ///< mean of the forward flows
  double variation = 0;    ///< standard deviation over mean of their rates in 200 ms, on average
  double jain = 1;         ///< of the forward flows
  Percentiles queue_ms;    ///< of their packets
  Percentiles frame_ms;    ///< creation to last packet
  double loss = 0;         ///< of all media packets
  double dropped = 0;      ///< of all frames, by senders
  double feedback = 0;     ///< bytes of reports over bytes of media
  double others_mbps = 0;  ///< mean of the flows of others, while they run
  double file_s = 0;       ///< mean time that a file of theirs took
  /// Delivered of two streams of one sender.
  std::optional<double> stream_ratio;
};

RmcatMetrics Measure(const RmcatCase& rmcat, const SimulationResult& result);

}  // namespace lidar::scream::test
