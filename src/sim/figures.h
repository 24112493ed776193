// SPDX-License-Identifier: LGPL-2.1-or-later
// Named figures of simulated runs, with their goals.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "src/sim/rmcat.h"
#include "src/sim/scenarios.h"

namespace lidar::scream::test {

struct FigureKind {
  const char* name;
  bool more_is_better = false;
  /// Differences of up to `absolute` plus `relative` times the value are ignored.
  double absolute = 0, relative = 0;
};

struct Figure {
  const FigureKind* kind = nullptr;
  double value = 0;
  std::optional<double> goal{};

  bool reached() const { return !goal || (kind->more_is_better ? value >= *goal : value <= *goal); }
  /// Returns the difference from `base` as a multiple of the largest difference that is ignored.
  /// The result is above 0 if this figure is better than `base`, and below 0 if it is worse.
  double BetterThan(const Figure& base) const;
};

/// Returns the figures of a matrix scenario, with their goals.
std::vector<Figure> Figures(const Scenario& scenario, const ScenarioMetrics& metrics);
std::vector<Figure> Figures(const RmcatCase& rmcat, const RmcatMetrics& metrics);
/// Returns the names of the scenarios that have a goal.
std::vector<std::string> ScenariosWithGoals();

}  // namespace lidar::scream::test
