// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that each scenario of the matrix reaches the goals of the extensions.
#include <gtest/gtest.h>

#include "src/sim/figures.h"

namespace lidar::scream::test {
namespace {

class ScenarioGoals : public ::testing::TestWithParam<std::string> {};

TEST_P(ScenarioGoals, AreReached) {
  const Scenario s = *FindScenario(GetParam(), Parameters());
  for (const Figure& figure : Figures(s, Measure(s, Simulate(s.config))))
    EXPECT_TRUE(figure.reached()) << figure.kind->name << " is " << figure.value << ", "
                                  << *figure.goal << " is the goal";
}
INSTANTIATE_TEST_SUITE_P(Matrix, ScenarioGoals, ::testing::ValuesIn(ScenariosWithGoals()));

/// The capacity falls three times, and each fall delays two scans. These are six of 560 scans, and
/// p99 is the seventh longest delay. The phases from 40 to 60 ms are left out, because a scan that
/// begins 40 to 60 ms after a fall is late as well. The sender does not know of the fall by then.
TEST(Goals, AScanBehindThoseOfACapacityDropIsInTime) {
  for (const Duration phase : {0ms, 10ms, 20ms, 30ms, 70ms, 80ms, 90ms}) {
    Scenario s = *FindScenario("frames10_steps_rtt40", Parameters());
    s.config.flows[0].start += phase;
    const ScenarioMetrics m = Measure(s, Simulate(s.config));
    EXPECT_LE(m.frame_ms.p99, 145) << phase / 1ms;
    EXPECT_LE(m.frames_dropped, 1) << phase / 1ms;
  }
}

TEST(Goals, LateWakeUpsAndVaryingFramesCostLittle) {
  Scenario s = *FindScenario("frames_20M_rtt25", Parameters());
  s.config.flows[0].wakeup_delay = 2ms;
  s.config.flows[0].sources[0].frame_jitter = 0.2;
  const ScenarioMetrics m = Measure(s, Simulate(s.config));
  EXPECT_GE(m.utilisation, 0.87);
  EXPECT_LE(m.queue_ms.p99, 8);
}

/// As on a radio link, packets are lost at random. The threads of the sender wake up late.
TEST(Goals, RandomLossCostsLittleWhereDelaysScatter) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    Scenario s = *FindScenario("frames_20M_loss2.0", Parameters());
    s.config.forward.seed = seed;
    s.config.flows[0].wakeup_delay = 2ms;
    EXPECT_GE(Measure(s, Simulate(s.config)).utilisation, 0.93) << seed;
  }
}

}  // namespace
}  // namespace lidar::scream::test
