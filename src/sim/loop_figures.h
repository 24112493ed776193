// SPDX-License-Identifier: LGPL-2.1-or-later
// Figures of runs over links with gaps, averaged over several starts.
#pragma once
#include <vector>

#include "src/sim/figures.h"
#include "src/sim/loop_case.h"

namespace lidar::loop {

/// Runs the case from `starts` places in its trace (see Later()), and returns the mean figures.
std::vector<scream::test::Figure> LoopFigures(const LoopCase& loop_case, int starts);

}  // namespace lidar::loop
