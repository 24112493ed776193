// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/link/capacity.h"

#include <gtest/gtest.h>

#include "src/sim/simulated_time.h"

namespace lidar::link {
namespace {
using namespace std::chrono_literals;

DataSize Bytes(std::int64_t n) { return DataSize::Bytes(n); }

TEST(Capacity, AConstantRateSerialisesAtThatRate) {
  const auto c = Capacity::Constant(Mbps(8));
  EXPECT_EQ(c.Finish(5ms, Bytes(1000)), 6ms);
  EXPECT_EQ(c.NextChange(1h), Duration::max());
}

TEST(Capacity, APacketAcrossAStepTakesBothRates) {
  const auto c = Capacity::Steps({Mbps(8), Mbps(4)}, 1s);
  EXPECT_EQ(c.Finish(999500us, Bytes(1000)), 1001ms);
  EXPECT_EQ(c.RateAt(1s), Mbps(4));
  EXPECT_EQ(c.RateAt(1h), Mbps(4)) << "the last rate stays";
  EXPECT_EQ(c.NextChange(0s), 1s);
  EXPECT_EQ(c.Between(500ms, 1500ms), Bytes(750000));
}

TEST(Capacity, StepsThatRepeatStartAgain) {
  const auto c = Capacity::Steps({Mbps(8), Mbps(4)}, 1s, true);
  EXPECT_EQ(c.RateAt(2s), Mbps(8));
  EXPECT_EQ(c.RateAt(3500ms), Mbps(4));
  EXPECT_EQ(c.NextChange(3500ms), 4s);
}

TEST(Capacity, StartsAnywhereInATrace) {
  auto c = Capacity::Steps({Mbps(8), Mbps(4), Mbps(2)}, 1s, true);
  c.AddOutage(2s, 2500ms);
  for (const Duration start : {0ms, 500ms, 1000ms, 2700ms, 3000ms, 7300ms}) {
    const Capacity later = c.StartingAt(start);
    for (Duration t{0}; t < 9s; t += 50ms)
      EXPECT_EQ(later.RateAt(t), c.RateAt(start + t)) << Seconds(start) << " " << Seconds(t);
    EXPECT_NEAR(later.Between(0s, 30s) / c.Between(start, start + 30s), 1, 1e-6);
  }
  EXPECT_EQ(Capacity::Steps({Mbps(8), Mbps(4)}, 1s).StartingAt(1500ms).RateAt(5s), Mbps(4));
}

TEST(Capacity, AGapHoldsThePacketUntilItEnds) {
  const auto c = Capacity::Steps({Mbps(8), Mbps(0), Mbps(8)}, 1s);
  EXPECT_EQ(c.Finish(999500us, Bytes(1000)), 2000500us);
  EXPECT_EQ(Capacity::Constant(Mbps(0)).Finish(0s, Bytes(1)), Duration::max());
}

TEST(Capacity, AnOutageStopsALinkOfAnyRate) {
  auto c = Capacity::Constant(Mbps(8));
  c.AddOutage(1s, 3s).AddOutage(2s, 4s);
  EXPECT_EQ(c.NextChange(0s), 1s);
  EXPECT_EQ(c.RateAt(3500ms), Mbps(0));
  EXPECT_EQ(c.Finish(1500ms, Bytes(1000)), 4001ms);
}

TEST(Capacity, AnOutageOfManyPeriodsIsNotSkippedWithThem) {
  auto c = Capacity::Steps({Mbps(1), Mbps(3)}, 1s, true);
  c.AddOutage(3s, 9s);
  EXPECT_EQ(c.Finish(0s, Bytes(5'000'000 / 8)), 3s);
  EXPECT_EQ(c.Finish(0s, Bytes(12'000'000 / 8)), 12s);
}

TEST(Capacity, ATinyRateInATinyPeriodIsNotCountedPeriodByPeriod) {
  const auto c = Capacity::Steps({DataRate::BitsPerSecond(1), Mbps(0)}, 1ns, true);
  EXPECT_NEAR(Seconds(c.Finish(0s, Bytes(1000))), 16000, 1);
  EXPECT_EQ(Capacity::Steps({Mbps(0)}, 1ms, true).Finish(0s, Bytes(1)), Duration::max());
}

TEST(Capacity, ReadsATraceWithCommentsBlankLinesAndWindowsEnds) {
  std::string error;
  const auto c = Capacity::ParseTrace("# drive\n\n0.5 10 # fade\r\n1.0\t2.5\n1.5,4", true, &error);
  ASSERT_TRUE(c) << error;
  EXPECT_EQ(c->RateAt(0s), Mbps(10)) << "the first rate holds from 0";
  EXPECT_EQ(c->RateAt(1s), Mbps(2.5));
  EXPECT_EQ(c->RateAt(1900ms), Mbps(4));
  EXPECT_EQ(c->RateAt(2s), Mbps(10)) << "the last line lasts as long as the one before";
  EXPECT_EQ(Capacity::ParseTrace("0 1\n1 2", false, &error)->RateAt(9s), Mbps(2));
}

TEST(Capacity, ReadsNoMoreLinesThanItsLimit) {
  std::string text;
  for (std::size_t i = 0; i <= Capacity::kMaxChanges; ++i) text += std::to_string(i) + " 1\n";
  std::string error;
  EXPECT_FALSE(Capacity::ParseTrace(text, false, &error));
  EXPECT_EQ(error, "line 1000001: too many lines");
}

class BadTrace : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(BadTrace, IsRefusedWithItsLine) {
  std::string error;
  EXPECT_FALSE(Capacity::ParseTrace(GetParam().first, true, &error));
  EXPECT_EQ(error, GetParam().second);
}

constexpr auto kShape = "line 1: expected two numbers, \"time_s rate_mbps\"";
INSTANTIATE_TEST_SUITE_P(All, BadTrace,
                         testing::Values(std::pair{"", "no line with a rate"},
                                         std::pair{"# only\n\n", "no line with a rate"},
                                         std::pair{"1", kShape}, std::pair{"1 2 3", kShape},
                                         std::pair{"a b", kShape}, std::pair{"1 2x", kShape},
                                         std::pair{"0 -1", "line 1: rate out of range"},
                                         std::pair{"0 nan", "line 1: rate out of range"},
                                         std::pair{"0 1e300", "line 1: rate out of range"},
                                         std::pair{"-1 1", "line 1: time out of range"},
                                         std::pair{"inf 1", "line 1: time out of range"},
                                         std::pair{"0 1\n0 2", "line 2: times must rise"},
                                         std::pair{"0 1\n1 2\n0.5 3", "line 3: times must rise"}));

}  // namespace
}  // namespace lidar::link
