// SPDX-License-Identifier: LGPL-2.1-or-later
// The named scenarios of the SCReAM matrix, for tests and for the program scream-matrix.
#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "src/sim/simulation.h"

namespace lidar::scream::test {

/// What a stream is made of: video frames, or the slices of LiDAR scans.
enum class Source { kFrames, kSlices };

struct Scenario {
  std::string name;
  std::string description;
  double frames_per_second = 50;
  Source source = Source::kFrames;
  SimulationConfig config;
  Duration settle = std::chrono::seconds(3);  ///< left out of utilisation and queue
  std::optional<Duration> drop_at;            ///< a capacity drop to look at
  bool beside_draft = false;                  ///< only the first flow is ours
};

/// All scenarios, with these parameters at the sender.
std::vector<Scenario> Scenarios(const Parameters& parameters);
/// Policers, silence, clocks: what happens in the course of a run.
std::vector<Scenario> EventScenarios(const Parameters& parameters);
/// Ours beside flows of others, and beside one of ours at other phases.
std::vector<Scenario> BesideScenarios(const Parameters& parameters);
std::optional<Scenario> FindScenario(const std::string& name, const Parameters& parameters);

struct DropMetrics {
  double peak_queue_ms = 0;
  double recovered_s = 0;   ///< until the queue is below 10 ms and stays there for 0.2 s
  double below_rate_s = 0;  ///< until the sent rate (50 ms) is below the new capacity
};

/// Figures of the mean flow on either side.
struct BesideMetrics {
  double ours_mbps = 0, theirs_mbps = 0;
  double their_loss = 0;
  /// How many times as much the larger one gets.
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
  double start_s = 0;  ///< until 90 % of capacity was delivered in 100 ms
  double start_peak_ms = 0;
  double frames_dropped = 0;
  double feedback_kbps = 0;
  DropMetrics drop;
  std::optional<BesideMetrics> beside;  ///< where there are flows of others
};

ScenarioMetrics Measure(const Scenario& scenario, const SimulationResult& result);

}  // namespace lidar::scream::test
