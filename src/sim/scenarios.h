// SPDX-License-Identifier: LGPL-2.1-or-later
// The named scenarios of the SCReAM matrix, for tests and for the program scream-matrix.
#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "src/sim/simulation.h"

namespace lidar::scream::test {

/// The kind of a stream: video frames, or slices of LiDAR scans.
enum class Source { kFrames, kSlices };

struct Scenario {
  std::string name;
  std::string description;
  double frames_per_second = 50;
  Source source = Source::kFrames;
  SimulationConfig config;
  Duration settle = std::chrono::seconds(3);  ///< not part of utilisation and queue delay
  std::optional<Duration> drop_at;            ///< time of the capacity drop that is measured
  bool beside_draft = false;                  ///< the other flows run the draft without extensions
};

/// Returns all scenarios. The sender of each has these parameters.
std::vector<Scenario> Scenarios(const Parameters& parameters);
/// Returns scenarios with policers, silent receivers and clock changes.
std::vector<Scenario> EventScenarios(const Parameters& parameters);
/// Returns scenarios in which our flow shares a link with other flows, or with flows of ours whose
/// frames are sent at other phases.
std::vector<Scenario> BesideScenarios(const Parameters& parameters);
std::optional<Scenario> FindScenario(const std::string& name, const Parameters& parameters);

struct DropMetrics {
  double peak_queue_ms = 0;
  double recovered_s = 0;  ///< from the drop until the queue stays below 10 ms for 0.2 s
  /// The time from the drop until the sent rate, measured over 50 ms, is below the new capacity.
  double below_rate_s = 0;
};

/// The mean figures of our flows, and of the other flows.
struct BesideMetrics {
  double ours_mbps = 0, theirs_mbps = 0;
  double their_loss = 0;
  /// Returns the larger of the two rates, divided by the smaller one.
  double ratio() const {
    return std::max(ours_mbps, theirs_mbps) / std::max(1e-9, std::min(ours_mbps, theirs_mbps));
  }
};

struct ScenarioMetrics {
  double utilisation = 0;
  Percentiles queue_ms;
  Percentiles frame_ms;
  double own_loss = 0;
  double jain = 1;     ///< of all flows
  double start_s = 0;  ///< from the start until 90 % of the capacity was delivered within 100 ms
  double start_peak_ms = 0;
  double frames_dropped = 0;
  double feedback_kbps = 0;
  DropMetrics drop;
  std::optional<BesideMetrics> beside;  ///< set if there are other flows
};

ScenarioMetrics Measure(const Scenario& scenario, const SimulationResult& result);

}  // namespace lidar::scream::test
