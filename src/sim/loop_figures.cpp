// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/sim/loop_figures.h"

#include <algorithm>

#include "src/sim/loop_goals.h"

namespace lidar::loop {
namespace {

using scream::test::Figure;
using scream::test::FigureKind;

constexpr FigureKind kOfOracle{"complete, of the oracle's [%]", true, 1, 0};
constexpr FigureKind kOfFixed{"complete, of a fixed step's [%]", true, 1, 0};
constexpr FigureKind kInTime{"in time, of a fixed step's [%]", true, 1.5, 0};
constexpr FigureKind kSpread{"spread of the starts [points]", false, 1, 0.2};
constexpr FigureKind kLoopUtilisation{"utilisation [%]", true, 4, 0};
constexpr FigureKind kLatency{"p95 over the oracle's [ms]", false, 10, 0.2};
constexpr FigureKind kBackAfterGap{"back after a gap [s]", false, 0.1, 0.2};

}  // namespace

std::vector<Figure> LoopFigures(const LoopCase& loop_case, int starts) {
  double oracle = 0, lowest = 1e9, highest = 0, utilisation = 0, latency = 0, back = 0;
  double complete = 0, in_time = 0, fixed_complete = 0, fixed_in_time = 0;
  for (int n = 0; n < starts; ++n) {
    LoopCase c = Later(loop_case, n);
    const LoopReport r = RunLoop(c).report;
    c.source.adapts = false;
    const LoopReport fixed = RunLoop(c).report;
    oracle += 100 * r.OfOracle() / starts;
    lowest = std::min(lowest, 100 * r.OfOracle());
    highest = std::max(highest, 100 * r.OfOracle());
    utilisation += 100 * r.utilisation / starts;
    latency += (r.capture_to_cloud_ms.p95 - r.oracle_at_mean.Latency(95)) / starts;
    back += r.recovery_s.max / starts;
    complete += static_cast<double>(r.complete);
    in_time += static_cast<double>(r.in_time);
    fixed_complete += static_cast<double>(fixed.complete);
    fixed_in_time += static_cast<double>(fixed.in_time);
  }
  const LoopGoals goals = GoalsOf(loop_case);
  std::vector<Figure> figures = {
      {&kOfOracle, oracle, goals.of_oracle},
      {&kOfFixed, 100 * complete / std::max(1.0, fixed_complete), goals.of_fixed},
      {&kInTime, 100 * in_time / std::max(1.0, fixed_in_time), goals.in_time_of_fixed},
      {&kSpread, highest - lowest},
      {&kLoopUtilisation, utilisation, goals.utilisation},
      {&kLatency, latency, goals.latency_over_oracle_ms},
      {&kBackAfterGap, back, goals.back_s},
  };
  return figures;
}

}  // namespace lidar::loop
