// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/link/trace_maker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "src/link/capacity.h"
#include "src/sim/simulated_time.h"

namespace lidar::link {
namespace {
using namespace std::chrono_literals;

Capacity Parse(const std::string& text) {
  std::string error;
  auto capacity = Capacity::ParseTrace(text, true, &error);
  EXPECT_TRUE(capacity) << error;
  return capacity.value_or(Capacity::Constant(Mbps(0)));
}

/// Returns the lengths of the gaps in tenths of a second.
std::vector<int> GapsOf(const Capacity& c, Duration duration) {
  std::vector<int> gaps;
  int length = 0;
  for (Duration t{0}; t < duration; t += 100ms) {
    if (c.RateAt(t + 50ms) <= Mbps(0.2)) {
      ++length;
    } else if (length > 0) {
      gaps.push_back(length);
      length = 0;
    }
  }
  return gaps;
}

class Drive : public ::testing::TestWithParam<std::uint64_t> {};  // the seed

TEST_P(Drive, HasTheMeanTheGapsAndTheFadesOfMeasuredOnes) {
  DriveTraceConfig config;
  config.seed = GetParam();
  const Capacity c = Parse(MakeDriveTrace(config));
  EXPECT_NEAR(c.Between(0s, 180s).bits() / 180e6, 8, 0.8);
  for (Duration t{0}; t < 180s; t += 100ms) ASSERT_GE(c.RateAt(t), Mbps(0.2));
  const std::vector<int> gaps = GapsOf(c, 180s);
  int in_gaps = 0;
  for (const int g : gaps) in_gaps += g;
  EXPECT_GE(gaps.size(), 35U);
  EXPECT_LE(gaps.size(), 90U);
  EXPECT_GE(in_gaps, 90) << "5 %";
  EXPECT_LE(in_gaps, 300) << "17 %";
  EXPECT_GE(*std::max_element(gaps.begin(), gaps.end()), 7);
  EXPECT_LE(*std::max_element(gaps.begin(), gaps.end()), 25);
  const auto ones = std::count(gaps.begin(), gaps.end(), 1);
  EXPECT_GE(ones, static_cast<std::ptrdiff_t>(gaps.size() / 4));
}
INSTANTIATE_TEST_SUITE_P(Seeds, Drive, ::testing::Values(1U, 2U, 3U, 4U, 5U));

TEST(TraceMaker, TheSameSeedGivesTheSameTraceAndAnotherOneAnother) {
  DriveTraceConfig config;
  const std::string first = MakeDriveTrace(config);
  EXPECT_EQ(MakeDriveTrace(config), first);
  config.seed = 2;
  EXPECT_NE(MakeDriveTrace(config), first);
}

TEST(TraceMaker, RegularGapsEndTheirPeriods) {
  GapTraceConfig config;
  config.every = 600ms;
  const Capacity c = Parse(MakeGapTrace(config));
  for (const Duration period : {0ms, 600ms, 54000ms}) {
    EXPECT_EQ(c.RateAt(period), Mbps(8));
    EXPECT_EQ(c.RateAt(period + 499ms), Mbps(8));
    EXPECT_EQ(c.RateAt(period + 500ms), Mbps(0.2));
    EXPECT_EQ(c.RateAt(period + 599ms), Mbps(0.2));
  }
}

TEST(TraceMaker, TheLastOfRegularGapsIsNoLongerWhereTheTraceStartsOver) {
  GapTraceConfig config;
  config.duration = 6s;
  const Capacity c = Parse(MakeGapTrace(config));
  EXPECT_EQ(c.RateAt(5950ms), Mbps(0.2));
  EXPECT_EQ(c.RateAt(6s), Mbps(8));
  EXPECT_EQ(GapsOf(c, 61s), std::vector<int>(30, 1));
}

TEST(TraceMaker, KeepsShortTimesAndLowRatesThatWereAskedFor) {
  GapTraceConfig config;
  config.every = 2ms;
  config.gap = 1800us;
  config.in_gaps = Mbps(0.0004);
  config.duration = 10ms;
  const Capacity c = Parse(MakeGapTrace(config));
  EXPECT_EQ(c.RateAt(2199us), Mbps(8));
  EXPECT_EQ(c.RateAt(2200us), Mbps(0.0004));
}

}  // namespace
}  // namespace lidar::link
