// SPDX-License-Identifier: LGPL-2.1-or-later
// Compares a stream over simulated links with the stream of a sender that knows the links in
// advance.
#include "tests/core/bonding/bonded_run.h"

#include <gtest/gtest.h>

#include <numeric>

#include "src/link/oracle.h"
#include "src/link/trace_maker.h"
#include "src/sim/simulated_time.h"

namespace lidar::bonding::test {
namespace {

using namespace std::chrono_literals;

link::Capacity Constant(double mbps) { return link::Capacity::Constant(Mbps(mbps)); }

link::Capacity Drive(std::uint64_t seed) {
  link::DriveTraceConfig config;
  config.seed = seed;
  std::string error;
  return *link::Capacity::ParseTrace(link::MakeDriveTrace(config), true, &error);
}

/// Returns a run whose source always uses the coarsest step. The rate of this source is r_min,
/// whatever the links carry.
RunConfig AtNeed(std::vector<LinkConfig> links) {
  RunConfig config;
  config.links = std::move(links);
  config.source.adapts = false;
  return config;
}

RunConfig Adaptive(std::vector<LinkConfig> links) {
  RunConfig config = AtNeed(std::move(links));
  config.source.adapts = true;
  return config;
}

double Bytes(const RunResult& r) {
  return static_cast<double>(
      std::accumulate(r.link_bytes.begin(), r.link_bytes.end(), std::int64_t{0}));
}

double Sent(const RunResult& r) { return Bytes(r) / static_cast<double>(r.media_bytes); }

/// The first oracle knows the capacity of the links in advance. The second oracle learns it after a
/// round trip.
TEST(TwoLinkRun, ReachesTheBoundOverGeneratedDrives) {
  double sum = 0, sum_late = 0;
  for (std::uint64_t seed = 1; seed <= 19; seed += 2) {
    const RunConfig config = AtNeed({{Drive(seed)}, {Drive(seed + 1)}});
    const RunResult run = Simulate(config);
    link::OracleConfig oracle;
    oracle.duration = config.duration;
    oracle.rate = DataSize::Bytes(run.media_bytes) / config.duration;
    const std::vector<link::Capacity> links = {config.links[0].capacity, config.links[1].capacity};
    const auto bound = link::AskOracleOfLinks(links, oracle);
    oracle.known_after = oracle.rtt;
    const auto late = link::AskOracleOfLinks(links, oracle);
    const auto in_time = static_cast<double>(run.in_time);
    const double share = in_time / static_cast<double>(bound.complete);
    const double share_late = in_time / static_cast<double>(late.complete);
    sum += share;
    sum_late += share_late;
    EXPECT_GE(share, 0.9932) << "seeds " << seed;
    EXPECT_GE(share_late, 0.9949) << "seeds " << seed;
    EXPECT_LE(run.Latency(95), bound.Latency(95) + 15) << "seeds " << seed;
  }
  EXPECT_GE(sum / 10, 0.9976);
  EXPECT_GE(sum_late / 10, 0.9983);
}

TEST(TwoLinkRun, LosesNothingWhereTheBetterLinkDiesAndComesBack) {
  LinkConfig better{Constant(10)};
  better.capacity.AddOutage(20s, 40s);
  const RunConfig config = AtNeed({better, {Constant(2)}});
  const RunResult run = Simulate(config);
  EXPECT_EQ(run.in_time, run.scans);
  const RunResult alone = Simulate(AtNeed({better}));
  EXPECT_LT(alone.in_time, alone.scans - 190);
}

TEST(TwoLinkRun, TargetFollowsTheOtherLinkWithinThreeTenthsOfASecond) {
  LinkConfig better{Constant(10)};
  better.capacity.AddOutage(20s, 40s);
  const RunResult run = Simulate(Adaptive({better, {Constant(3)}}));
  DataRate before, after;
  for (const RunResult::Target& t : run.targets) {
    if (t.time <= 20s) before = t.rate;
    if (t.time <= 20300ms) after = t.rate;
  }
  EXPECT_GT(before, Mbps(8));
  EXPECT_LT(after, Mbps(3.5));
}

TEST(TwoLinkRun, TakesALinkBackWithinASecond) {
  LinkConfig better{Constant(10)};
  better.capacity.AddOutage(20s, 40s);
  const RunResult run = Simulate(Adaptive({better, {Constant(2)}}));
  DataRate back;
  for (const RunResult::Target& t : run.targets)
    if (t.time > 40s && t.time <= 41s) back = std::max(back, t.rate);
  EXPECT_GT(back, Mbps(3));
}

struct Pair {
  const char* name;
  LinkConfig better, other;
};
class UnequalLinks : public testing::TestWithParam<Pair> {};

TEST_P(UnequalLinks, AreNeverWorseThanTheBetterOneAlone) {
  const Pair& p = GetParam();
  const RunResult both = Simulate(Adaptive({p.better, p.other}));
  const RunResult alone = Simulate(Adaptive({p.better}));
  EXPECT_GE(both.in_time, alone.in_time);
  EXPECT_LE(both.Latency(95), alone.Latency(95) + 2);
  const RunResult reversed = Simulate(Adaptive({p.other, p.better}));
  EXPECT_GE(reversed.in_time + 1, alone.in_time) << "the worse one is named first";
}

INSTANTIATE_TEST_SUITE_P(
    Pairs, UnequalLinks,
    testing::Values(Pair{"round_trips", {Constant(10), 20ms}, {Constant(10), 150ms}},
                    Pair{"capacities", {Constant(10)}, {Constant(1)}},
                    Pair{"loss", {Constant(10)}, {Constant(10), 40ms, 0.02}}),
    [](const auto& pair) { return pair.param.name; });

TEST(TwoLinkRun, SendsLittleTwiceOnLinksThatAreSettled) {
  RunConfig config = AtNeed({{Constant(20)}, {Constant(20)}});
  const double adaptive = Sent(Simulate(config));
  config.method = Method::kBroadcast;
  const double broadcast = Sent(Simulate(config));
  EXPECT_NEAR(broadcast, 2, 0.01);
  EXPECT_LE(adaptive, 0.6 * broadcast);
}

/// If both links carried a packet, a report on the packet does not show which link it belongs to.
/// Broadcast sends all packets over both links.
TEST(TwoLinkRun, GoesOnWhereFeedbackIsSwapped) {
  for (const Method method : {Method::kAdaptive, Method::kBroadcast})
    for (const Duration from : {0s, 20s}) {
      RunConfig config = AtNeed({{Constant(8)}, {Constant(8), 60ms}});
      config.method = method;
      config.swapped_from = from;
      const RunResult run = Simulate(config);
      EXPECT_GE(run.Share(), 0.99) << "from " << Seconds(from);
    }
}

TEST(TwoLinkRun, OneLinkOfFourIsEnough) {
  LinkConfig dead{Constant(8)};
  dead.capacity.AddOutage(0s, 1h);
  const RunResult run = Simulate(AtNeed({dead, dead, {Constant(8)}, dead}));
  EXPECT_EQ(run.in_time, run.scans);
  EXPECT_LT(run.Latency(99), 60);
}

TEST(TwoLinkRun, GoesOnWhereALinkHasNoRoute) {
  LinkConfig none{Constant(8)};
  none.unusable_from = 0s;
  none.unusable_until = 30s;
  const RunResult run = Simulate(AtNeed({none, {Constant(8)}}));
  EXPECT_EQ(run.in_time, run.scans);
}

struct Company {
  scream::test::TcpKind kind;
  double mbps;
  double most = 1.2;  // as a multiple of the share of one link
};
class OneBottleneck : public testing::TestWithParam<Company> {};

TEST_P(OneBottleneck, GivesTwoLinksLittleMoreThanOne) {
  const auto& [kind, mbps, most] = GetParam();
  LinkConfig link{Constant(mbps)};
  if (kind == scream::test::TcpKind::kPrague)
    link.aqm.kind = link::AqmConfig::Kind::kRamp;
  else
    link.limit.time = 100ms;
  RunConfig config = Adaptive({link});
  config.one_bottleneck = true;
  config.others.emplace_back().kind = kind;
  double one = 0, two = 0;
  for (config.source.seed = 1; config.source.seed <= 5; ++config.source.seed) {
    config.links = {link};
    one += Bytes(Simulate(config));
    config.links.push_back(link);
    two += Bytes(Simulate(config));
  }
  EXPECT_LE(two, most * one);
}

INSTANTIATE_TEST_SUITE_P(Beside, OneBottleneck,
                         testing::Values(Company{scream::test::TcpKind::kCubic, 4},
                                         Company{scream::test::TcpKind::kCubic, 8, 1.4},
                                         Company{scream::test::TcpKind::kPrague, 4},
                                         Company{scream::test::TcpKind::kPrague, 12}));

TEST(TwoLinkRun, CarriesAsMuchThroughOneQueueAsOneLink) {
  RunConfig config = Adaptive({{Constant(8)}, {Constant(8)}});
  config.one_bottleneck = true;
  const RunResult two = Simulate(config);
  config.links.pop_back();
  const RunResult one = Simulate(config);
  EXPECT_GE(static_cast<double>(two.media_bytes), 0.9 * static_cast<double>(one.media_bytes));
}

TEST(TwoLinkRun, BearsALinkThatDuplicatesAndReordersBy300Milliseconds) {
  LinkConfig odd{Constant(10)};
  odd.path.reorder = 0.1;
  odd.path.reorder_delay = 300ms;
  odd.path.duplicate = 0.1;
  for (const auto& links : {std::vector<LinkConfig>{odd, {Constant(10)}}, {{Constant(10)}, odd}}) {
    const RunResult run = Simulate(AtNeed(links));
    EXPECT_EQ(run.in_time, run.scans);
  }
}

TEST(TwoLinkRun, BearsReceiversWhoseClocksDiffer) {
  LinkConfig ahead{Constant(10)};
  ahead.receiver_clock = 1h;
  const RunResult run = Simulate(Adaptive({{Constant(10)}, ahead}));
  EXPECT_EQ(run.in_time, run.scans);
  EXPECT_EQ(run.latency_ms, Simulate(Adaptive({{Constant(10)}, {Constant(10)}})).latency_ms);
}

TEST(TwoLinkRun, SumsWhatLinksCarryWhereItIsAskedFor) {
  RunConfig config = Adaptive({{Constant(4)}, {Constant(4)}});
  const RunResult better = Simulate(config);
  config.rule = TargetRule::kSum;
  const RunResult sum = Simulate(config);
  EXPECT_GT(sum.media_bytes, better.media_bytes * 6 / 5);
  EXPECT_GE(static_cast<double>(sum.in_time), 0.95 * static_cast<double>(sum.scans));
}

}  // namespace
}  // namespace lidar::bonding::test
