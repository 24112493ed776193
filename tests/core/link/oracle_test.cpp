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

TEST(OracleOfLinks, WithoutLinksOrSlicesDeliversNothing) {
  EXPECT_EQ(AskOracleOfLinks({}, TenSeconds(1)).complete, 0U);
  EXPECT_EQ(AskOracleOfLinks({}, TenSeconds(1)).scans, 100U);
  EXPECT_EQ(AskOracleOfLinks({Trace("0 8")}, {}).scans, 0U);
}

}  // namespace
}  // namespace lidar::link
