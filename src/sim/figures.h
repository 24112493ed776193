// SPDX-License-Identifier: LGPL-2.1-or-later
// Figures of simulated runs by name, and the goals that they are to reach.
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
  /// Differences up to `absolute` plus `relative` of the value do not count.
  double absolute = 0, relative = 0;
};

struct Figure {
  const FigureKind* kind = nullptr;
  double value = 0;
  std::optional<double> goal{};

  bool reached() const { return !goal || (kind->more_is_better ? value >= *goal : value <= *goal); }
  /// The number of such differences by which it is better than `base`; negative for worse.
  double BetterThan(const Figure& base) const;
};

/// What each scenario of the matrix is to reach, and the other figures that are compared.
std::vector<Figure> Figures(const Scenario& scenario, const ScenarioMetrics& metrics);
std::vector<Figure> Figures(const RmcatCase& rmcat, const RmcatMetrics& metrics);
/// Scenarios that have a goal.
std::vector<std::string> ScenariosWithGoals();

}  // namespace lidar::scream::test
