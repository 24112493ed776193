// SPDX-License-Identifier: LGPL-2.1-or-later
// Figures of runs over links with gaps, as means over several starts.
#pragma once
#include <vector>

#include "src/sim/figures.h"
#include "src/sim/loop_case.h"

namespace lidar::loop {

/// Each of `starts` runs begins elsewhere in the trace; see Later().
std::vector<scream::test::Figure> LoopFigures(const LoopCase& loop_case, int starts);

}  // namespace lidar::loop
