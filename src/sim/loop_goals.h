// SPDX-License-Identifier: LGPL-2.1-or-later
// Goals of the whole loop over links with gaps.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "src/sim/loop_case.h"

namespace lidar::loop {

/// A goal, and whether a run has reached it.
struct GoalResult {
  std::string text;  // "complete 98.1 % of the oracle's, 97 % wanted"
  bool holds = false;
};

/// The goals for the mean of runs from several starts.
struct LoopGoals {
  double of_oracle = 0;                 ///< complete scans [%], relative to the oracle's
  double of_fixed = 98.5;               ///< complete scans [%], relative to a fixed step
  double in_time_of_fixed = 98;         ///< scans in time [%], relative to a fixed step
  std::optional<double> utilisation{};  ///< [%]
  std::optional<double> latency_over_oracle_ms{};
  std::optional<double> back_s{};
};
LoopGoals GoalsOf(const LoopCase& loop_case);

/// Checks the goals of the case. Traces with regular gaps have a goal for the recovery after a gap,
/// too.
std::vector<GoalResult> CheckGoals(const LoopCase& loop_case, const LoopReport& report);

/// Checks that an adapting encoder is never worse than the coarsest step within the same error
/// bound.
GoalResult CheckAgainstFixed(const LoopReport& report, const LoopReport& fixed);

}  // namespace lidar::loop
