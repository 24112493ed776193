// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests how several streams of one controller, and several controllers, share a link.
#include <gtest/gtest.h>

#include <utility>

#include "src/sim/scenarios.h"
#include "src/sim/simulated_time.h"

namespace lidar::scream::test {
namespace {

/// One sender with two streams: the slices of a LiDAR and the frames of a camera.
class TwoStreams : public ::testing::Test {
 protected:
  void SetUp() override {
    FlowConfig& flow = scenario.config.flows[0];
    flow.sources.push_back(flow.sources[0]);
    Lidar().frames_per_second = 80;
    Lidar().frame_jitter = 0.1;
    Camera().frames_per_second = 30;
    Camera().frame_jitter = 0.3;
  }
  SourceConfig& Lidar() { return scenario.config.flows[0].sources[0]; }
  SourceConfig& Camera() { return scenario.config.flows[0].sources[1]; }
  void Run() {
    result = Simulate(scenario.config);
    metrics = Measure(scenario, result);
  }
  /// Returns the rate at which the stream `source` arrived [Mbit/s]. The first 5 s do not count.
  double Rate(int source) const {
    const Time origin = scenario.config.forward.origin;
    const Time end = origin + scenario.config.duration;
    return static_cast<double>(result.DeliveredBytes(origin + 5s, end, 0, source)) * 8 / 1e6 /
           Seconds(end - origin - 5s);
  }

  Scenario scenario = *FindScenario("frames_8M_rtt40", Parameters());
  SimulationResult result;
  ScenarioMetrics metrics;
};

TEST_F(TwoStreams, ShareWhatIsAboveTheirMinimaByPriority) {
  Lidar().stream.priority = 3;
  Lidar().stream.min_bitrate = Camera().stream.min_bitrate = Mbps(0.4);
  Run();
  EXPECT_NEAR((Rate(0) - 0.4) / (Rate(1) - 0.4), 3, 0.15);
  EXPECT_GT(metrics.utilisation, 0.85);
  EXPECT_LT(metrics.queue_ms.p99, 7);
}

TEST_F(TwoStreams, AStarvedStreamKeepsItsMinimum) {
  scenario.config.forward.capacity = link::Capacity::Constant(Mbps(1));
  Lidar().stream.priority = 100;
  Camera().stream.min_bitrate = Mbps(0.4);
  Lidar().stream.start_bitrate = Camera().stream.start_bitrate = Mbps(0.4);
  Run();
  EXPECT_NEAR(Rate(1), 0.4, 0.03);
  EXPECT_GT(Rate(0), 0.3);
  EXPECT_EQ(metrics.own_loss, 0);
}

TEST_F(TwoStreams, WhatOneAtItsMaximumLeavesGoesToTheOther) {
  Lidar().stream.priority = 10;
  Lidar().stream.max_bitrate = Mbps(2);
  Run();
  EXPECT_NEAR(Rate(0), 2, 0.06);
  EXPECT_GT(Rate(1), 5);
}

TEST_F(TwoStreams, AnEncoderThatIgnoresItsTargetDoesNotTakeTheOthersShare) {
  Camera().obedience = [](Duration) { return 2.0; };
  Run();
  EXPECT_GT(Rate(0), 3.2);
  EXPECT_LT(metrics.queue_ms.p99, 10);
}

/// The first stream is strict and has a low rate, as audio has. The encoder of the second stream
/// sends twice its target.
TEST_F(TwoStreams, AStrictOneNeverWaitsForTheOther) {
  Camera().obedience = [](Duration) { return 2.0; };
  Lidar().stream.strict = true;
  Lidar().stream.max_bitrate = Mbps(0.2);
  Lidar().stream.start_bitrate = Mbps(0.2);
  Run();
  EXPECT_NEAR(Rate(0), 0.2, 0.02);
  std::vector<double> latency_ms;
  for (const FrameLog& f : result.flows[0].frames)
    if (f.source == 0 && f.complete()) latency_ms.push_back(Milliseconds(f.arrival - f.created));
  EXPECT_LT(Summarise(latency_ms).p99, 35);
}

/// A second LiDAR stops after 2 s. The minimum rate that was reserved for it must become free
/// again.
TEST(SilentStream, LeavesTheLiveOneAsItWas) {
  for (const double needed : {5.0, 10.0, 20.0}) {
    Scenario s = *FindScenario("frames_20M_rtt25", Parameters());
    const double alone = Measure(s, Simulate(s.config)).utilisation;
    FlowConfig& flow = s.config.flows[0];
    flow.sources.push_back(flow.sources[0]);
    flow.sources[1].stream.min_bitrate = Mbps(needed);
    flow.sources[1].frames_per_second = 10;
    flow.sources[1].stop_at = 2s;
    s.settle = 5s;
    const ScenarioMetrics m = Measure(s, Simulate(s.config));
    EXPECT_GT(m.utilisation, alone - 0.02) << needed;
    EXPECT_LT(m.queue_ms.p99, 5) << needed;
  }
}

class BesideClassic : public ::testing::TestWithParam<const char*> {};

TEST_P(BesideClassic, NeitherGetsMuchMoreNorLosesMuchMore) {
  const Scenario s = *FindScenario(GetParam(), Parameters());
  const ScenarioMetrics m = Measure(s, Simulate(s.config));
  EXPECT_LE(m.beside->ratio(), 2.2) << m.beside->ours_mbps << " and " << m.beside->theirs_mbps;
  EXPECT_LE(m.own_loss, m.beside->their_loss + 0.01);
}
INSTANTIATE_TEST_SUITE_P(ShortQueues, BesideClassic,
                         ::testing::Values("cubic_fifo_15ms_8M", "cubic_fifo_5ms_20M",
                                           "cubic_fifo_10ms_20M", "cubic_fifo_20ms_20M",
                                           "cubic_fifo_2ms_50M", "cubic_fifo_5ms_50M",
                                           "cubic_fifo_10ms_50M", "reno_fifo_5ms_20M",
                                           "cubic_pi2_20M", "cubic_dualpi2_20M"));

TEST(BesideOthers, TheStatisticsTellTheirShare) {
  const auto cross_traffic = [](const char* name) {
    return Simulate(FindScenario(name, Parameters())->config).flows[0].statistics.cross_traffic;
  };
  EXPECT_NEAR(cross_traffic("prague_ramp_20M"), 0.55, 0.25);
  EXPECT_EQ(cross_traffic("frames_20M_rtt25"), 0);
}

/// Packets arrive as far apart as they were sent both on an idle link and on a link full of other
/// flows. Jitter must not make the sender take an idle link for a full one.
TEST(BesideOthers, NobodyIsFoundOnAnIdleLinkThatJitters) {
  Scenario s = *FindScenario("frames_20M_jitter4", Parameters());
  s.config.forward.path.jitter = 8ms;
  s.config.flows[0].sources[0].stream.max_bitrate = Mbps(5);
  for (const bool l4s : {true, false}) {
    if (!l4s) s.config.flows[0].parameters.ecn = Ecn::kNotEct;
    EXPECT_EQ(Simulate(s.config).flows[0].statistics.cross_traffic, 0) << l4s;
  }
}

double Jain(Scenario s, double frames_per_second = 50) {
  s.config.flows[0].sources[0].frames_per_second = frames_per_second;
  return Measure(s, Simulate(s.config)).jain;
}

/// The flow that joins last is the slowest flow, so it learns least about the other flows.
TEST(BesideOthers, FourOfOursThatJoinOneAfterTheOtherShareAlike) {
  Scenario s = *FindScenario("frames_20M_rtt25", Parameters());
  for (int i = 1; i <= 3; ++i) {
    s.config.flows.push_back(s.config.flows[0]);
    s.config.flows.back().start += i * 5005ms;
  }
  s.config.duration = 100s;
  s.settle = 40s;
  EXPECT_GE(Measure(s, Simulate(s.config)).jain, 0.99);
}

TEST(BesidePrague, OneOfThreeGetsAThird) {
  Scenario s = *FindScenario("prague_ramp_20M", Parameters());
  s.config.others.push_back(s.config.others[0]);
  EXPECT_NEAR(Measure(s, Simulate(s.config)).beside->ours_mbps, 6.7, 1.3);
}

/// A slow flow has few packets that show the share of the other flows. An even share of the link is
/// 5 Mbit/s with three other flows, and 4 Mbit/s with four.
TEST(BesidePrague, OneThatJoinsThreeOrFourIsNotLeftBehind) {
  for (const int others : {3, 4}) {
    Scenario s = *FindScenario("prague_ramp_20M", Parameters());
    s.config.others.assign(static_cast<std::size_t>(others), {TcpKind::kPrague});
    s.config.flows[0].start += 20s;
    s.config.duration = 100s;
    s.settle = 50s;
    EXPECT_GE(Measure(s, Simulate(s.config)).beside->ours_mbps, 18.0 / (others + 1)) << others;
  }
}

/// On a slow link, packets are few and far apart. If each measurement of the flow's own rate
/// counted as a drop of the capacity, Jain's index of frames would fall to 0.64 and 0.88.
TEST(BesidePrague, AtFewMegabitsItGetsItsShareAsWell) {
  const std::pair<const char*, double> even[] = {{"prague_ramp_4M", 0.95},
                                                 {"prague_ramp_8M", 0.97}};
  for (const auto& [name, index] : even)
    for (const double frames_per_second : {10.0, 50.0, 80.0})
      EXPECT_GE(Jain(*FindScenario(name, Parameters()), frames_per_second), index)
          << name << " " << frames_per_second;
}

TEST(Alone, AFlowOfOneMegabitUsesItsLink) {
  Scenario s = *FindScenario("frames_8M_rtt40", Parameters());
  s.config.forward.capacity = link::Capacity::Constant(Mbps(1));
  EXPECT_GE(Measure(s, Simulate(s.config)).utilisation, 0.93);
}

/// If each round with mostly marked packets counted as a drop of the capacity, Jain's index would
/// fall to 0.80 and 0.87.
TEST(BesidePrague, BothGetAboutTheSameBehindAStepAsWell) {
  for (const char* name : {"prague_step_1ms_20M", "prague_step_3ms_20M"})
    for (const double frames_per_second : {50.0, 80.0})
      EXPECT_GE(Jain(*FindScenario(name, Parameters()), frames_per_second), 0.95)
          << name << " " << frames_per_second;
}

/// The pacer must spread the packets of a whole scan evenly. Otherwise the flow would get less than
/// Prague.
TEST(BesidePrague, WholeScansGetAboutTheSame) {
  EXPECT_GE(Jain(*FindScenario("prague_ramp_20M", Parameters()), 10), 0.97);
}

TEST(TwoFlows, WhoseFramesMeetShareALinkEvenly) {
  Scenario s = *FindScenario("frames_20M_two_flows", Parameters());
  s.config.flows[1].start = s.config.flows[0].start + 5s;
  s.settle = 20s;
  EXPECT_GE(Measure(s, Simulate(s.config)).jain, 0.99);
}

/// On a slow link, a flow has few packets that show it the share of the other flow.
TEST(TwoFlows, ShareASlowLinkEvenlyAtAnyPhase) {
  const auto phases = {0ms, 1ms, 3ms, 4ms, 6ms, 7ms, 9ms, 10ms, 12ms, 13ms, 15ms, 17ms, 19ms};
  double sum = 0;
  for (const Duration phase : phases) {
    Scenario s = *FindScenario("prague_ramp_8M", Parameters());
    s.config.others.clear();
    s.config.flows.push_back(s.config.flows[0]);
    s.config.flows[1].start += 5s + phase;
    const double jain = Measure(s, Simulate(s.config)).jain;
    EXPECT_GE(jain, 0.97) << Milliseconds(phase);
    sum += jain;
  }
  EXPECT_GE(sum / static_cast<double>(phases.size()), 0.99);
}

/// The two flows never send a frame at the same time, and the frames of one flow get more marks.
/// With the draft alone, Jain's index would be 0.87.
TEST(TwoFlows, WhoseFramesNeverMeetKeepTheirBalanceAndTheQueue) {
  for (const char* name : {"frames_20M_two_flows", "frames_8M_rtt40"}) {
    for (const Duration phase : {4ms, 10ms}) {
      Scenario s = *FindScenario(name, Parameters());
      if (s.config.flows.size() == 1) s.config.flows.push_back(s.config.flows[0]);
      s.config.flows[1].start = s.config.flows[0].start + 5s + phase;
      s.config.duration = 45s;
      s.settle = 20s;
      const ScenarioMetrics m = Measure(s, Simulate(s.config));
      EXPECT_GE(m.jain, 0.95) << name << " " << Milliseconds(phase);
      EXPECT_GE(m.utilisation, 0.95) << name << " " << Milliseconds(phase);
      EXPECT_LE(m.queue_ms.p99, 8) << name << " " << Milliseconds(phase);
    }
  }
}

}  // namespace
}  // namespace lidar::scream::test
