// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/link/oracle.h"

#include <gtest/gtest.h>

#include "src/link/trace_maker.h"
#include "src/sim/simulated_time.h"

namespace lidar::link {
namespace {
using namespace std::chrono_literals;

OracleResult Ask(const std::string& trace, double mbps) {
  std::string error;
  OracleConfig config;
  config.rate = Mbps(mbps);
  return AskOracle(*Capacity::ParseTrace(trace, true, &error), config);
}

TEST(Oracle, DeliversEveryScanOverALinkThatCarriesThem) {
  const OracleResult r = Ask("0 8\n1 8\n", 1.4);
  EXPECT_EQ(r.scans, 600U);
  EXPECT_EQ(r.complete, 600U);
  EXPECT_NEAR(r.Latency(50), 20 + 2.2, 0.5) << "half the round trip and 17.5 kbit at 8 Mbit/s";
}

TEST(Oracle, DeliversTheShareThatFits) {
  const OracleResult r = Ask("0 1\n1 1\n", 2);
  EXPECT_NEAR(static_cast<double>(r.complete), 300, 5);
  EXPECT_LE(r.latency_ms.back(), 500);
}

TEST(Oracle, LosesTheScansOfAGapThatIsLongerThanTheyKeep) {
  GapTraceConfig gaps;
  gaps.gap = 1s;
  gaps.every = 10s;
  const OracleResult r = Ask(MakeGapTrace(gaps), 1.4);
  EXPECT_NEAR(static_cast<double>(r.complete), 556, 6);
  EXPECT_NEAR(r.Latency(50), 22, 0.5);
  gaps.gap = 100ms;
  gaps.every = 2s;
  EXPECT_NEAR(static_cast<double>(Ask(MakeGapTrace(gaps), 1.4).complete), 599, 1);
}

TEST(Oracle, KeepsTheNewestScanHoweverOld) {
  std::string error;
  OracleConfig config;
  config.rate = Mbps(1.4);
  config.duration = 10s;
  config.scans_per_second = 2;
  const auto c = Capacity::ParseTrace("0 8\n0.95 0\n1.35 8", false, &error);
  EXPECT_EQ(AskOracle(*c, config).complete, 20U);
}

TEST(Oracle, FinishesAScanThatHasBegunToLeave) {
  std::string error;
  OracleConfig config;
  config.rate = Mbps(1.4);
  config.duration = 10s;
  const auto c = Capacity::ParseTrace("0 8\n1.001 0\n1.45 8", false, &error);
  EXPECT_EQ(AskOracle(*c, config).complete, 98U);
  const auto sooner = Capacity::ParseTrace("0 8\n0.999 0\n1.45 8", false, &error);
  EXPECT_EQ(AskOracle(*sooner, config).complete, 97U);
}

TEST(Oracle, AskedForNothingDeliversNothing) {
  EXPECT_EQ(AskOracle(Capacity::Constant(Mbps(8)), {}).complete, 0U);
  OracleConfig config;
  config.rate = Mbps(1);
  EXPECT_EQ(AskOracle(Capacity::Constant(Mbps(0)), config).complete, 0U);
  EXPECT_EQ(AskOracle(Capacity::Constant(DataRate::Infinite()), config).complete, 600U);
}

Capacity Trace(const std::string& text) {
  std::string error;
  return *Capacity::ParseTrace(text, false, &error);
}

OracleConfig TenSeconds(double mbps) {
  OracleConfig config;
  config.rate = Mbps(mbps);
  config.duration = 10s;
  return config;
}

TEST(OracleOfLinks, SecondLinkBridgesTheGapsOfTheFirst) {
  GapTraceConfig gaps;
  gaps.gap = 1s;
  gaps.every = 10s;
  std::string error;
  const auto first = *Capacity::ParseTrace(MakeGapTrace(gaps), true, &error);
  OracleConfig config;
  config.rate = Mbps(1.4);
  const OracleResult one = AskOracleOfLinks({first}, config);
  EXPECT_LT(one.complete, 560U);
  const OracleResult two = AskOracleOfLinks({first, first.StartingAt(5s)}, config);
  EXPECT_EQ(two.complete, two.scans);
  EXPECT_NEAR(two.Latency(99), 22, 1);
}

TEST(OracleOfLinks, LinksThatStandStillTogetherHelpNot) {
  const Capacity gap = Trace("0 8\n2 0\n3 8");
  const OracleResult one = AskOracleOfLinks({gap}, TenSeconds(1.4));
  const OracleResult two = AskOracleOfLinks({gap, gap}, TenSeconds(1.4));
  EXPECT_LT(one.complete, 93U);
  EXPECT_LE(two.complete, one.complete + 1);
}

TEST(OracleOfLinks, AddsCapacitiesWhereEachSliceGoesOneWay) {
  const std::vector<Capacity> links(2, Trace("0 1.2"));
  EXPECT_EQ(AskOracleOfLinks(links, TenSeconds(2)).complete, 100U);
  EXPECT_LT(AskOracleOfLinks(links, TenSeconds(2), Bonding::kOnEach).complete, 100U)
      << "each link alone carries 1.2 of 2 Mbit/s";
}

TEST(OracleOfLinks, IsNoWorseThanTheBestLinkWhereOthersAreDead) {
  const Capacity good = Trace("0 8"), dead = Trace("0 0");
  const OracleResult four = AskOracleOfLinks({dead, good, dead, dead}, TenSeconds(1.4));
  const OracleResult one = AskOracleOfLinks({good}, TenSeconds(1.4));
  EXPECT_EQ(four.complete, one.complete);
  EXPECT_EQ(four.latency_ms, one.latency_ms);
}

TEST(OracleOfLinks, CountsWhatArrivesInTime) {
  const OracleResult r = AskOracleOfLinks({Trace("0 1.2"), Trace("0 1.2")}, TenSeconds(3));
  EXPECT_LT(r.complete, r.scans);
  EXPECT_LE(r.latency_ms.back(), 200);
  EXPECT_GT(r.latency_ms.back(), 180);
}

OracleConfig KnownAfter(Duration delay) {
  OracleConfig config = TenSeconds(1.4);
  config.known_after = delay;
  return config;
}

/// A slice is in time if it is sent within 180 ms after its capture.
TEST(OracleOfLinks, UsesALinkAgainWhenTheEndOfItsGapIsKnown) {
  const std::vector<Capacity> gap = {Trace("0 8\n2 0\n3 8")};
  EXPECT_EQ(AskOracleOfLinks(gap, KnownAfter(0ms)).complete, 91U) << "those from 2.9 s on";
  EXPECT_EQ(AskOracleOfLinks(gap, KnownAfter(40ms)).complete, 91U);
  EXPECT_EQ(AskOracleOfLinks(gap, KnownAfter(100ms)).complete, 90U) << "those from 3.0 s on";
  EXPECT_EQ(AskOracleOfLinks(gap, KnownAfter(200ms)).complete, 89U) << "those from 3.1 s on";
}

/// Each slice has 17.5 kbit. The gap is known at 2.04 s. The slices from 2.0 to 2.0375 s are on the
/// link by then, and are sent when the gap ends. The slice of 2.05 s is sent after 2.14 s.
TEST(OracleOfLinks, HoldsSlicesThatAreMadeInAKnownGap) {
  const std::vector<Capacity> gap = {Trace("0 8\n2 0\n2.1 8")};
  const OracleResult late = AskOracleOfLinks(gap, KnownAfter(40ms));
  const OracleResult ahead = AskOracleOfLinks(gap, KnownAfter(0ms));
  const std::size_t second = late.latency_ms.size() - 2;
  ASSERT_EQ(late.latency_ms.size(), ahead.latency_ms.size());
  EXPECT_NEAR(late.latency_ms.back(), 122.1875, 1e-2) << "made at 2.0 s";
  EXPECT_NEAR(ahead.latency_ms.back(), 122.1875, 1e-2);
  EXPECT_NEAR(late.latency_ms[second], 112.1875, 1e-2) << "made at 2.05 s";
  EXPECT_NEAR(ahead.latency_ms[second], 111.875, 1e-2) << "made at 2.0125 s";
}

TEST(OracleOfLinks, LosesNothingOverConstantLinksThatAreKnownLate) {
  const std::vector<Capacity> links = {Trace("0 1"), Trace("0 0.5")};
  const OracleResult ahead = AskOracleOfLinks(links, KnownAfter(0ms));
  const OracleResult late = AskOracleOfLinks(links, KnownAfter(1s));
  EXPECT_EQ(late.complete, ahead.complete);
  EXPECT_EQ(late.latency_ms, ahead.latency_ms);
}

TEST(OracleOfLinks, DeliversLessTheLaterItKnows) {
  for (std::uint64_t seed = 1; seed <= 5; seed += 2) {
    DriveTraceConfig first, second;
    first.seed = seed;
    second.seed = seed + 1;
    const std::vector<Capacity> links = {Trace(MakeDriveTrace(first)),
                                         Trace(MakeDriveTrace(second))};
    OracleConfig config;
    config.rate = Mbps(1.5);
    OracleResult sooner = AskOracleOfLinks(links, config);
    for (const Duration delay : {20ms, 40ms, 100ms, 200ms}) {
      config.known_after = delay;
      const OracleResult later = AskOracleOfLinks(links, config);
      EXPECT_LE(later.complete, sooner.complete) << Milliseconds(delay);
      EXPECT_GE(later.Latency(99), sooner.Latency(99)) << Milliseconds(delay);
      sooner = later;
    }
  }
}

TEST(OracleOfLinks, WithoutLinksOrSlicesDeliversNothing) {
  EXPECT_EQ(AskOracleOfLinks({}, TenSeconds(1)).complete, 0U);
  EXPECT_EQ(AskOracleOfLinks({}, TenSeconds(1)).scans, 100U);
  EXPECT_EQ(AskOracleOfLinks({Trace("0 8")}, {}).scans, 0U);
}

}  // namespace
}  // namespace lidar::link
