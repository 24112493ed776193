// SPDX-License-Identifier: LGPL-2.1-or-later
// What the loop is to reach over links with gaps.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "src/sim/loop_case.h"

namespace lidar::loop {

/// A goal of a run, and what came of it.
struct GoalResult {
  std::string text;  // "complete 98.1 % of the oracle's, 97 % wanted"
  bool holds = false;
};

/// What the mean of runs from several starts is to reach.
struct LoopGoals {
  double of_oracle = 0;                 ///< complete scans [%]
  double of_fixed = 98.5;               ///< complete scans [%]
  double in_time_of_fixed = 98;         ///< [%]
  std::optional<double> utilisation{};  ///< [%]
  std::optional<double> latency_over_oracle_ms{};
  std::optional<double> back_s{};
};
LoopGoals GoalsOf(const LoopCase& loop_case);

/// The goals of this kind of run; with gaps, those of a trace with gaps.
std::vector<GoalResult> CheckGoals(const LoopCase& loop_case, const LoopReport& report);

/// Adapting is never worse than the coarsest step of the same bound.
GoalResult CheckAgainstFixed(const LoopReport& report, const LoopReport& fixed);

}  // namespace lidar::loop
