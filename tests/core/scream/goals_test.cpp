// SPDX-License-Identifier: LGPL-2.1-or-later
// What the extensions are for: the scenarios of the matrix and what must be reached in each.
#include <gtest/gtest.h>

#include "tests/core/scream/scenarios.h"

namespace lidar::scream::test {
namespace {

struct Goal {
  const char* scenario;
  double utilisation;
  double queue_p95_ms, queue_p99_ms, queue_max_ms;
  double frame_p95_ms;
  double own_loss = 0;
};
std::ostream& operator<<(std::ostream& out, const Goal& g) { return out << g.scenario; }

class ScenarioGoal : public ::testing::TestWithParam<Goal> {};

TEST_P(ScenarioGoal, IsReached) {
  const Goal& goal = GetParam();
  const Scenario s = *FindScenario(goal.scenario, Parameters());
  const ScenarioMetrics m = Measure(s, Simulate(s.config));
  EXPECT_GE(m.utilisation, goal.utilisation);
  EXPECT_LE(m.queue_ms.p95, goal.queue_p95_ms);
  EXPECT_LE(m.queue_ms.p99, goal.queue_p99_ms);
  EXPECT_LE(m.queue_ms.max, goal.queue_max_ms);
  EXPECT_LE(m.frame_ms.p95, goal.frame_p95_ms);
  EXPECT_LE(m.own_loss, goal.own_loss);
  EXPECT_LE(m.start_peak_ms, 50);
  EXPECT_GE(m.jain, 0.99);
}
INSTANTIATE_TEST_SUITE_P(
    Matrix, ScenarioGoal,
    ::testing::Values(Goal{"A", 0.90, 5, 5, 10, 35}, Goal{"A-slices", 0.90, 5, 5, 15, 30},
                      Goal{"C", 0.90, 5, 5, 10, 45}, Goal{"C10", 0.80, 5, 8, 15, 110},
                      Goal{"C10-slices", 0.90, 5, 5, 15, 40}, Goal{"D", 0.95, 32, 40, 60, 70},
                      Goal{"D-slices", 0.95, 32, 40, 60, 70}, Goal{"E", 0.85, 10, 45, 140, 50},
                      Goal{"E10", 0.72, 10, 45, 140, 130},
                      Goal{"E10-slices", 0.85, 10, 45, 140, 50}, Goal{"G0.5", 0.80, 5, 5, 10, 35},
                      Goal{"G1.0", 0.80, 5, 5, 10, 35}, Goal{"G2.0", 0.80, 5, 5, 10, 35},
                      Goal{"J", 0.85, 5, 5, 10, 40}, Goal{"K", 0.80, 10, 10, 12, 60, 0.01},
                      Goal{"K-slices", 0.80, 10, 10, 12, 60, 0.01}));

TEST(Goals, ACapacityDropIsAnsweredWithinARoundTrip) {
  for (const char* name : {"H", "H-slices"}) {
    const Scenario s = *FindScenario(name, Parameters());
    const ScenarioMetrics m = Measure(s, Simulate(s.config));
    EXPECT_LE(m.drop.peak_queue_ms, 150) << name;
    EXPECT_LE(m.drop.recovered_s, 0.35) << name;
    EXPECT_LE(m.drop.below_rate_s, 0.15) << name;
  }
}

TEST(Goals, NinetyPercentAreReachedWithinASecondAndAHalfWithoutALongQueue) {
  const Scenario s = *FindScenario("A", Parameters());
  const ScenarioMetrics m = Measure(s, Simulate(s.config));
  EXPECT_LE(m.start_s, 1.5);
  EXPECT_LE(m.start_peak_ms, 30);
}

TEST(Goals, LateWakeUpsAndVaryingFramesCostLittle) {
  Scenario s = *FindScenario("A", Parameters());
  s.config.flows[0].wakeup_delay = 2ms;
  s.config.flows[0].sources[0].frame_jitter = 0.2;
  const ScenarioMetrics m = Measure(s, Simulate(s.config));
  EXPECT_GE(m.utilisation, 0.87);
  EXPECT_LE(m.queue_ms.p99, 8);
}

}  // namespace
}  // namespace lidar::scream::test
