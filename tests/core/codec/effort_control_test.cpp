// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/effort_control.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace lidar::codec {
namespace {

/// A machine that runs the encoder. `speeds` are the speeds at the efforts 0 to 3, in million
/// returns per second.
struct Machine {
  std::array<double, 4> speeds = {38, 8, 5, 2};
  double factor = 1;
  double noise = 0.1;
};

/// A sensor with 8 slices per scan and 10 scans per second.
struct Sensor {
  std::size_t returns = 2'700;  // per slice
  Duration sweep{12'500'000};
};

/// Encodes slices for `seconds`, and returns the effort that was used for each slice.
std::vector<unsigned> Play(const Machine& machine, const Sensor& sensor, double seconds,
                           EffortControl* control) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> noise(1 - machine.noise, 1 + machine.noise);
  std::vector<unsigned> efforts;
  const auto slices = static_cast<int>(seconds / Seconds(sensor.sweep));
  for (int i = 0; i < slices; ++i) {
    efforts.push_back(control->effort());
    const double speed = 1e6 * machine.speeds[control->effort()] * machine.factor;
    const double spent_s = static_cast<double>(sensor.returns) / speed * noise(random);
    control->OnSlice(sensor.sweep, sensor.returns, FromSeconds(spent_s));
  }
  return efforts;
}

unsigned Changes(const std::vector<unsigned>& efforts) {
  unsigned changes = 0;
  for (std::size_t i = 1; i < efforts.size(); ++i)
    changes += efforts[i] != efforts[i - 1] ? 1U : 0U;
  return changes;
}

TEST(EffortControl, TakesTheHighestEffortThatFits) {
  struct Case {
    std::size_t returns;
    unsigned effort;
  };
  // A slice of 12.5 ms may be encoded for 3.1 ms. This is enough for 6,200 returns at effort 3, for
  // 15,600 at effort 2 and for 25,000 at effort 1.
  for (const Case& c : {Case{2'700, 3}, Case{10'000, 2}, Case{20'000, 1}, Case{60'000, 0}}) {
    EffortControl control;
    EXPECT_EQ(Play({}, {c.returns}, 10, &control).back(), c.effort) << c.returns;
  }
}

TEST(EffortControl, IsThereWithinSeconds) {
  EffortControl control;
  EXPECT_EQ(Play({}, {}, 3, &control).back(), 3U);
}

TEST(EffortControl, DecidesByNoFewerThanEightSlicesHoweverLongTheyAre) {
  EffortControl control;
  const unsigned first = control.effort();
  const Duration sweep = std::chrono::milliseconds(500);
  for (int i = 0; i < 7; ++i) control.OnSlice(sweep, 1'000, std::chrono::microseconds(10));
  EXPECT_EQ(control.effort(), first);
  control.OnSlice(sweep, 1'000, std::chrono::microseconds(10));
  EXPECT_EQ(control.effort(), first + 1);
}

TEST(EffortControl, StaysWhereItIsHoweverNearTheLimit) {
  for (std::size_t returns = 3'000; returns < 60'000; returns += 1'000) {
    EffortControl control;
    Machine machine;
    machine.noise = 0.3;
    Play(machine, {returns}, 20, &control);
    EXPECT_LE(Changes(Play(machine, {returns}, 120, &control)), 6U) << returns;
  }
}

TEST(EffortControl, YieldsAtOnceToABusyMachineAndComesBack) {
  EffortControl control;
  Machine machine;
  EXPECT_EQ(Play(machine, {}, 10, &control).back(), 3U);
  machine.factor = 0.1;
  const auto busy = Play(machine, {}, 0.2, &control);
  EXPECT_LT(busy.back(), 3U);
  Play(machine, {}, 5, &control);
  EXPECT_EQ(control.effort(), 0U);
  machine.factor = 1;
  EXPECT_EQ(Play(machine, {}, 120, &control).back(), 3U);
}

TEST(EffortControl, FallsByOneLevelForEachThreeSlicesThatAreMuchTooLate) {
  EffortControl control;
  ASSERT_EQ(Play({}, {}, 10, &control).back(), 3U);
  for (unsigned slice = 1; slice <= 12; ++slice) {
    control.OnSlice(Duration{12'500'000}, 2'700, Duration{9'000'000});
    EXPECT_EQ(control.effort(), 3 - std::min(3U, slice / 3)) << slice;
  }
}

TEST(EffortControl, WaitsLongerEachTimeThatAnEffortFailed) {
  EffortControl control;
  std::vector<double> raised_at;  // [s]
  unsigned before = 0;
  for (int i = 0; i < 100 * 80; ++i) {
    const bool fails = control.effort() == 3;
    if (fails && before != 3) raised_at.push_back(i / 80.0);
    before = control.effort();
    control.OnSlice(Duration{12'500'000}, 100, Duration{fails ? 10'000'000 : 20'000});
  }
  ASSERT_GE(raised_at.size(), 4U);
  for (std::size_t i = 2; i < raised_at.size(); ++i)
    EXPECT_GT(raised_at[i] - raised_at[i - 1], 1.5 * (raised_at[i - 1] - raised_at[i - 2]));
}

/// Each slice has 1,000 returns. The encoder needs a tenth of the sweep for it at effort 2, and 2.7
/// times as long at effort 3.
TEST(EffortControl, LearnsWhatALevelCostsFromTheFirstWindowOfItAlone) {
  EffortControl control;
  const auto play = [&](double seconds, Duration at_effort_1, Duration at_effort_2) {
    for (int i = 0; i < seconds * 80; ++i)
      control.OnSlice(Duration{12'500'000}, 1'000,
                      control.effort() == 1 ? at_effort_1 : at_effort_2);
  };
  play(3, Duration{735'000}, Duration{1'250'000});
  ASSERT_EQ(control.effort(), 2U);
  play(12, Duration{1'470'000}, Duration{2'500'000});
  ASSERT_EQ(control.effort(), 2U) << "a slower machine is still fast enough";
  for (int i = 0; i < 3; ++i) control.OnSlice(Duration{12'500'000}, 1'000, Duration{9'000'000});
  ASSERT_EQ(control.effort(), 1U);
  play(10, Duration{735'000}, Duration{1'250'000});
  EXPECT_EQ(control.effort(), 2U) << "it costs what it cost at first";
}

TEST(EffortControl, LetsSingleSlicesBeLate) {
  EffortControl control;
  Play({}, {}, 10, &control);
  for (int i = 0; i < 1'000; ++i) {
    const bool late = i % 20 == 0;
    control.OnSlice(Duration{12'500'000}, 2'700, Duration{late ? 9'000'000 : 1'300'000});
    ASSERT_EQ(control.effort(), 3U);
  }
}

/// A sensor behind a window sees the road in one slice of eight, and the sky in the other slices.
TEST(EffortControl, LeavesRoomForTheSliceWithTheMostReturns) {
  EffortControl control;
  const Machine machine;
  unsigned late = 0;
  constexpr int kSeconds = 60;
  for (int i = 0; i < kSeconds * 80; ++i) {
    const std::size_t returns = i % 8 == 3 ? 10'000 : 1'000;
    const double spent_s = static_cast<double>(returns) / (1e6 * machine.speeds[control.effort()]);
    late += spent_s > EffortControl::kAllowedPart * 0.0125;
    control.OnSlice(Duration{12'500'000}, returns, FromSeconds(spent_s));
  }
  EXPECT_EQ(control.effort(), 2U) << "effort 3 takes 5 ms of 3.1 for the road";
  EXPECT_EQ(late, 0U);
}

TEST(EffortControl, StandsSlicesWithoutReturnsOrDuration) {
  EffortControl control;
  for (int i = 0; i < 1'000; ++i) {
    control.OnSlice(Duration{i % 2 * 100'000'000}, 0, Duration{0});
    ASSERT_LE(control.effort(), EffortControl::kHighest);
  }
}

}  // namespace
}  // namespace lidar::codec
