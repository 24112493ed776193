// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that the simulated TCP flows use a link fully when alone, and that their windows follow the
// published response functions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "src/sim/simulated_time.h"
#include "src/sim/simulation.h"

namespace lidar::scream::test {
namespace {

SimulationConfig Path(TcpKind kind, DataRate capacity, Duration rtt) {
  SimulationConfig config;
  config.flows.clear();
  config.others = {{kind}};
  config.forward.origin = kStart;
  config.forward.capacity = link::Capacity::Constant(capacity);
  config.forward.delay = config.return_delay = rtt / 2;
  config.duration = 60s;
  return config;
}

double Utilisation(const SimulationResult& result) {
  return result.Utilisation(kStart + 10s, kStart + 59s);
}

double RateOf(const SimulationResult& result, int flow, Duration from, Duration until) {
  return static_cast<double>(result.DeliveredBytes(kStart + from, kStart + until, flow)) * 8 / 1e6 /
         Seconds(until - from);
}

class Greedy : public ::testing::TestWithParam<TcpKind> {};

TEST_P(Greedy, FillsALinkWhoseBufferIsItsBandwidthDelayProduct) {
  SimulationConfig config = Path(GetParam(), Mbps(20), 40ms);
  config.forward.limit.bytes = Mbps(20) * 40ms;
  const SimulationResult r = Simulate(config);
  EXPECT_GE(Utilisation(r), 0.97);
  EXPECT_LE(static_cast<double>(r.others[0].packets_lost),
            0.01 * static_cast<double>(r.others[0].packets_sent));
}

TEST_P(Greedy, GivesWayToASecondOne) {
  SimulationConfig config = Path(GetParam(), Mbps(20), 40ms);
  config.forward.limit.bytes = Mbps(20) * 40ms;
  config.others.push_back({GetParam(), 10s});
  config.duration = 180s;
  const SimulationResult r = Simulate(config);
  const double first = RateOf(r, 0, 60s, 179s), second = RateOf(r, 1, 60s, 179s);
  EXPECT_NEAR(first / second, 1, 0.35) << first << " and " << second;
}

TEST_P(Greedy, SurvivesAnOutage) {
  SimulationConfig config = Path(GetParam(), Mbps(20), 40ms);
  config.forward.limit.bytes = Mbps(20) * 40ms;
  config.forward.capacity.AddOutage(20s, 25s);
  const SimulationResult r = Simulate(config);
  EXPECT_GE(r.Utilisation(kStart + 35s, kStart + 59s), 0.9);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Greedy,
                         ::testing::Values(TcpKind::kReno, TcpKind::kCubic, TcpKind::kPrague));

/// Returns the mean window over a path whose only limit is random loss.
double MeanWindowUnderLoss(TcpKind kind, double loss, Duration rtt) {
  double sum = 0;
  constexpr int kRuns = 2;
  for (int seed = 1; seed <= kRuns; ++seed) {
    SimulationConfig config = Path(kind, Mbps(10000), rtt);
    config.forward.loss = loss;
    config.forward.seed = static_cast<std::uint64_t>(seed);
    config.duration = 300s;
    config.others[0].slow_start_threshold = 100;
    sum += Simulate(config).others[0].mean_window / kRuns;
  }
  return sum;
}

/// Reno's window is sqrt(3/2p) if losses are periodic, and 1.31/sqrt(p) if losses are independent.
/// The simulated window must be between these values.
TEST(Response, OfRenoFallsWithTheSquareRootOfTheLoss) {
  for (const double p : {0.0005, 0.002, 0.01}) {
    const double window = MeanWindowUnderLoss(TcpKind::kReno, p, 50ms) * std::sqrt(p);
    EXPECT_GE(window, 0.92 * 1.22) << p;
    EXPECT_LE(window, 1.08 * 1.31) << p;
  }
}

/// The window in RFC 9438, section 5.1, is 1.054 RTT^0.75 / p^0.75, if this is more than Reno's
/// window.
TEST(Response, OfCubicFallsWithItsThreeQuarterPower) {
  for (const double p : {0.00003, 0.0001}) {
    const double published = 1.054 * std::pow(0.1, 0.75) / std::pow(p, 0.75);
    EXPECT_NEAR(MeanWindowUnderLoss(TcpKind::kCubic, p, 100ms) / published, 1, 0.15) << p;
  }
}

TEST(Response, OfCubicIsRenosWhereThatIsMore) {
  for (const double p : {0.001, 0.005}) {
    const double ratio = MeanWindowUnderLoss(TcpKind::kCubic, p, 20ms) /
                         MeanWindowUnderLoss(TcpKind::kReno, p, 20ms);
    EXPECT_NEAR(ratio, 1, 0.15) << p;
  }
}

TEST(Prague, KeepsTheQueueAtAStepAndTheLinkFull) {
  SimulationConfig config = Path(TcpKind::kPrague, Mbps(20), 40ms);
  config.forward.aqm.kind = link::AqmConfig::Kind::kStep;
  config.forward.aqm.high = 2ms;
  const SimulationResult r = Simulate(config);
  EXPECT_GE(Utilisation(r), 0.95);
  EXPECT_LE(r.QueueDelay(kStart + 10s, kStart + 60s).p99, 6);
  EXPECT_EQ(r.others[0].packets_lost, 0U);
}

/// RFC 9332 promises that a classic flow and an L4S flow get about the same rate.
TEST(Prague, SharesADualQueueWithCubic) {
  SimulationConfig config = Path(TcpKind::kPrague, Mbps(40), 20ms);
  config.others.push_back({TcpKind::kCubic});
  config.forward.aqm.kind = link::AqmConfig::Kind::kDualPi2;
  const SimulationResult r = Simulate(config);
  const double prague = RateOf(r, 0, 15s, 59s), cubic = RateOf(r, 1, 15s, 59s);
  EXPECT_GE(Utilisation(r), 0.95);
  EXPECT_LE(std::max(prague, cubic) / std::min(prague, cubic), 2) << prague << " and " << cubic;
}

/// Each file is a single packet. If the packet is late, the sender sends it again after a second.
/// The acknowledgement of the late packet then arrives while another file is being sent.
TEST(Files, TakeARoundTripAtLeastThoughAcknowledgementsOfEarlierFilesComeLate) {
  SimulationConfig config = Path(TcpKind::kCubic, Mbps(20), 40ms);
  config.forward.path.reorder = 0.02;
  config.forward.path.reorder_delay = 2s;
  config.others[0].files = FileConfig{DataSize::Bytes(1500), DataSize::Bytes(1500)};
  const std::vector<double> times = Simulate(config).others[0].file_s;
  ASSERT_GT(times.size(), 100U);
  EXPECT_GE(*std::min_element(times.begin(), times.end()), 0.04);
  EXPECT_GE(*std::max_element(times.begin(), times.end()), 1.0) << "no packet was late";
}

/// Returns a flow that sends files of one packet each over an otherwise empty link.
SimulationConfig SmallFiles() {
  SimulationConfig config = Path(TcpKind::kCubic, Mbps(20), 40ms);
  config.others[0].files = FileConfig{DataSize::Bytes(1500), DataSize::Bytes(1500)};
  return config;
}

TEST(Files, FollowOneAnotherAtOnceAndEachTakesItsOwnTime) {
  const std::vector<double> times = Simulate(SmallFiles()).others[0].file_s;
  double sum = 0;
  for (const double time : times) {
    ASSERT_NEAR(time, 0.041, 0.001);
    sum += time;
  }
  EXPECT_NEAR(sum, 60, 0.1);
}

TEST(Files, ComeAfterPausesThatAreNoTimeOfTheirs) {
  SimulationConfig config = SmallFiles();
  config.others[0].files->mean_pause = 1s;
  const std::vector<double> times = Simulate(config).others[0].file_s;
  for (const double time : times) ASSERT_NEAR(time, 0.041, 0.001);
  EXPECT_NEAR(static_cast<double>(times.size()), 60 / 1.041, 20);
}

TEST(Files, HaveSizesBetweenTheirBounds) {
  SimulationConfig config = SmallFiles();
  config.others[0].files = FileConfig{DataSize::Bytes(15'000), DataSize::Bytes(30'000)};
  const TcpResult result = Simulate(config).others[0];
  const double packets = static_cast<double>(result.packets_sent);
  EXPECT_NEAR(packets / static_cast<double>(result.file_s.size()), 15.5, 0.7);
}

TEST(Files, EndWithTheirFlow) {
  SimulationConfig config = SmallFiles();
  config.others[0].start = 10s;
  config.others[0].stop = 20s;
  const SimulationResult result = Simulate(config);
  EXPECT_NEAR(static_cast<double>(result.others[0].file_s.size()), 10 / 0.041, 5);
  EXPECT_EQ(result.DeliveredBytes(kStart, kStart + 10s), 0);
  EXPECT_EQ(result.DeliveredBytes(kStart + 20s + 40ms, kStart + 60s), 0);
}

TEST(Classic, AnEcnMarkCountsAsALoss) {
  SimulationConfig config = Path(TcpKind::kCubic, Mbps(20), 40ms);
  config.others[0].ecn = Ecn::kEct0;
  config.forward.aqm.kind = link::AqmConfig::Kind::kPi2;
  const SimulationResult r = Simulate(config);
  EXPECT_GE(Utilisation(r), 0.93);
  EXPECT_NEAR(r.QueueDelay(kStart + 10s, kStart + 60s).p50, 15, 10);
  EXPECT_EQ(r.others[0].packets_lost, 0U);
}

}  // namespace
}  // namespace lidar::scream::test
