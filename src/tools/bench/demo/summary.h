// SPDX-License-Identifier: LGPL-2.1-or-later
// Computes the figures of a run, and checks its guarantees.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "src/tools/bench/demo/measurements.h"

namespace lidar::demo {

/// The behaviour of the queue after a step of the capacity.
struct Transient {
  double at_s = 0;
  double from_bps = 0;
  double to_bps = 0;
  double peak_ms = 0;
  // The time after the step until the queue stays below 10 ms for half a second.
  double settled_after_s = 0;
};
std::vector<Transient> FindTransients(const Measurements& m);

struct Guarantee {
  std::string text;
  bool holds = false;
};
/// Checks the guarantees that must hold on any network path. The exit code depends on them.
std::vector<Guarantee> CheckGuarantees(const Measurements& m);

nlohmann::ordered_json Summarise(const Measurements& m);

}  // namespace lidar::demo
