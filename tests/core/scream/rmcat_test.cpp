// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests the figures of a test case of RFC 8867 and RFC 8869. The tests write the log by hand.
#include "src/sim/rmcat.h"

#include <gtest/gtest.h>

#include "src/sim/figures.h"
#include "src/sim/simulated_time.h"

namespace lidar::scream::test {
namespace {

/// A link of 8 Mbit/s that is measured for two seconds. Each packet has 100 kB, so one packet per
/// second is 0.8 Mbit/s.
class RmcatFigures : public ::testing::Test {
 protected:
  static constexpr std::int64_t kBytes = 100'000;

  RmcatFigures() {
    case_.config.forward.origin = kStart;
    case_.config.forward.capacity = link::Capacity::Constant(Mbps(8));
    case_.from = 1s;
    case_.until = 3s;
    case_.config.flows.assign(1, RmcatVideo(Parameters(), {}, 2));
    result_.flows.resize(1);
  }
  void AddFlow() {
    case_.forward.push_back(static_cast<int>(case_.config.flows.size()));
    case_.config.flows.push_back(case_.config.flows.front());
    result_.flows.emplace_back();
  }
  void AddOther(const TcpConfig& config = {}) {
    case_.config.others.push_back(config);
    result_.others.emplace_back();
  }
  PacketLog& Send(Duration at, int flow = 0) {
    result_.packets.push_back({kStart + at, kStart + at + 10ms, 5, flow, 0, kBytes, true});
    return result_.packets.back();
  }
  RmcatMetrics Get() const { return Measure(case_, result_); }

  RmcatCase case_;
  SimulationResult result_;
};

TEST_F(RmcatFigures, CountPacketsOfTheMeasuredTimeOnly) {
  for (const Duration at : {500ms, 1000ms, 1500ms, 2000ms, 2500ms, 3000ms}) Send(at).sojourn_ms = 9;
  Send(2900ms).delivered = false;
  const RmcatMetrics m = Get();
  EXPECT_DOUBLE_EQ(m.loss, 0.2);
  EXPECT_DOUBLE_EQ(m.media_mbps, 4 * 0.4);
  EXPECT_DOUBLE_EQ(m.queue_ms.max, 9);
  // The flow sends at most 2 Mbit/s, so it cannot use more of the link.
  EXPECT_DOUBLE_EQ(m.utilisation, 4 * 0.4 / 2);
}

TEST_F(RmcatFigures, LeaveTheQueuesOfOtherFlowsOut) {
  AddOther();
  Send(1500ms).sojourn_ms = 3;
  Send(1500ms, 1).sojourn_ms = 77;
  Send(1500ms, 1).delivered = false;
  const RmcatMetrics m = Get();
  EXPECT_DOUBLE_EQ(m.queue_ms.max, 3);
  EXPECT_DOUBLE_EQ(m.loss, 0);
  EXPECT_DOUBLE_EQ(m.utilisation, 2 * 0.4 / 8) << "a greedy flow can use the whole link";
}

TEST_F(RmcatFigures, TakeBackgroundFlowsForWhatTheyCanUse) {
  TcpConfig files;
  files.files = FileConfig{DataSize::Bytes(1), DataSize::Bytes(1)};
  files.start = 2s;
  AddOther(files);
  TcpConfig elsewhere;
  elsewhere.files = files.files;
  elsewhere.route = {1};
  AddOther(elsewhere);
  Send(1500ms, 1);
  Send(2500ms, 1);
  Send(1500ms, 2);
  result_.others[0].file_s = {1, 2};
  result_.others[1].file_s = {6};
  const RmcatMetrics m = Get();
  EXPECT_DOUBLE_EQ(m.utilisation, 2 * 0.4 / 2) << "files do not fill a link";
  EXPECT_DOUBLE_EQ(m.others_mbps, (0.8 + 0.4) / 2) << "each while it runs";
  EXPECT_DOUBLE_EQ(m.file_s, 3);
}

TEST_F(RmcatFigures, TakeABackgroundFlowThatStopsForWhatItSentUntilThen) {
  TcpConfig config;
  config.stop = 2s;
  AddOther(config);
  Send(1500ms, 1);
  EXPECT_DOUBLE_EQ(Get().others_mbps, 0.8);
}

TEST_F(RmcatFigures, CompareTheSharesOfTheFlows) {
  AddFlow();
  for (const Duration at : {1200ms, 1600ms, 2400ms}) Send(at);
  EXPECT_DOUBLE_EQ(Get().jain, 0.5) << "one flow gets all";
  Send(2600ms, 1);
  EXPECT_DOUBLE_EQ(Get().jain, 16.0 / (2 * 10));
  EXPECT_DOUBLE_EQ(Get().media_mbps, 4 * 0.4 / 2);
  EXPECT_FALSE(Get().stream_ratio);
}

TEST_F(RmcatFigures, SayHowMuchTheRateVaries) {
  for (Duration t = 1s; t < 3s; t += 200ms) Send(t);
  EXPECT_NEAR(Get().variation, 0, 1e-9);
  result_.packets.clear();
  for (Duration t = 1s; t < 3s; t += 400ms) Send(t);
  EXPECT_NEAR(Get().variation, 1, 1e-9);
}

TEST_F(RmcatFigures, CountFramesAndReports) {
  FlowResult& flow = result_.flows[0];
  for (const Duration at : {500ms, 1000ms, 2000ms, 3000ms})
    flow.frames.push_back({kStart + at, 0, 1000, 2, 2, kStart + at + (at == 2s ? 40ms : 20ms)});
  // One packet of this frame is missing.
  flow.frames.push_back({kStart + 2s, 0, 1000, 2, 1, kStart + 9s});
  flow.frames_dropped = 1;
  flow.feedback_bytes = 30;
  flow.delivered_bytes = 1000;
  const RmcatMetrics m = Get();
  EXPECT_DOUBLE_EQ(m.dropped, 0.2);
  EXPECT_DOUBLE_EQ(m.feedback, 0.03);
  EXPECT_DOUBLE_EQ(m.frame_ms.max, 40);
}

TEST_F(RmcatFigures, CompareTheFirstStreamOfASenderWithItsSecond) {
  case_.config.flows[0].sources.resize(2);
  for (const Duration at : {1000ms, 2000ms, 2500ms}) Send(at);
  Send(2s).source = 1;
  ASSERT_TRUE(Get().stream_ratio);
  EXPECT_DOUBLE_EQ(*Get().stream_ratio, 3);
}

/// The value and the goal of a figure, by its name; -1: no goal.
struct Row {
  const char* name;
  double value;
  double goal = -1;
};
void ExpectRows(const std::vector<Figure>& figures, const std::vector<Row>& rows) {
  ASSERT_EQ(figures.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_STREQ(figures[i].kind->name, rows[i].name);
    EXPECT_DOUBLE_EQ(figures[i].value, rows[i].value) << rows[i].name;
    EXPECT_DOUBLE_EQ(figures[i].goal.value_or(-1), rows[i].goal) << rows[i].name;
  }
}

/// Metrics that all differ.
ScenarioMetrics AnyMetrics() {
  ScenarioMetrics m;
  m.utilisation = 0.5;
  m.queue_ms = {1, 2, 3, 4};
  m.frame_ms = {5, 6, 7, 8};
  m.own_loss = 0.25;
  m.jain = 0.9;
  m.start_s = 10;
  m.start_peak_ms = 11;
  m.frames_dropped = 12;
  m.drop = {13, 14, 15};
  return m;
}

TEST(FiguresOfRuns, OfAScenarioHaveItsGoalsAlsoThatOfNoLoss) {
  Scenario s;
  s.name = "frames_20M_rtt25";
  ExpectRows(Figures(s, AnyMetrics()), {{"utilisation [%]", 50, 98},
                                        {"queue p95 [ms]", 2, 5},
                                        {"queue p99 [ms]", 3, 4},
                                        {"queue max [ms]", 4, 10},
                                        {"frame p95 [ms]", 6, 35},
                                        {"frame p99 [ms]", 7},
                                        {"own loss [%]", 25, 0},
                                        {"Jain's index", 0.9, 0.99},
                                        {"frames dropped", 12},
                                        {"start [s]", 10, 1.5},
                                        {"queue of the start [ms]", 11, 30}});
}

TEST(FiguresOfRuns, OfAScenarioWithADropOrOtherFlowsShowThese) {
  Scenario s;
  s.name = "of no goal";
  s.drop_at = 10s;
  ScenarioMetrics m = AnyMetrics();
  m.beside = BesideMetrics{2, 8, 0.125};
  ExpectRows(Figures(s, m), {{"utilisation [%]", 50},
                             {"queue p95 [ms]", 2},
                             {"queue p99 [ms]", 3},
                             {"queue max [ms]", 4},
                             {"frame p95 [ms]", 6},
                             {"frame p99 [ms]", 7},
                             {"own loss [%]", 25},
                             {"Jain's index", 0.9},
                             {"frames dropped", 12},
                             {"larger over smaller share", 4},
                             {"ours [Mbit/s]", 2},
                             {"theirs [Mbit/s]", 8},
                             {"their loss [%]", 12.5},
                             {"drop: peak [ms]", 13, 150},
                             {"drop: below 10 ms [s]", 14, 0.35},
                             {"drop: rate below [s]", 15, 0.15}});
}

TEST(FiguresOfRuns, OfRmcatAreLimitedWhereTheFlowsAreAlone) {
  RmcatMetrics m;
  m.utilisation = 0.5;
  m.media_mbps = 1;
  m.variation = 2;
  m.jain = 0.8;
  m.queue_ms = {3, 4, 5, 6};
  m.frame_ms = {7, 8, 9, 10};
  m.loss = 0.25;
  m.dropped = 0.125;
  m.feedback = 0.0625;
  m.others_mbps = 11;
  RmcatCase c;
  ExpectRows(Figures(c, m), {{"utilisation [%]", 50, 80},
                             {"media [Mbit/s]", 1, 0.15},
                             {"variation of the rate", 2},
                             {"queue p95 [ms]", 4, 100},
                             {"queue p99 [ms]", 5},
                             {"frame p95 [ms]", 8},
                             {"own loss [%]", 25, 1},
                             {"frames dropped [%]", 12.5, 2},
                             {"feedback over media [%]", 6.25}});
  c.config.others.emplace_back();
  c.forward = {0, 1};
  m.file_s = 12;
  m.stream_ratio = 13;
  ExpectRows(Figures(c, m), {{"utilisation [%]", 50},
                             {"media [Mbit/s]", 1, 0.15},
                             {"variation of the rate", 2},
                             {"queue p95 [ms]", 4},
                             {"queue p99 [ms]", 5},
                             {"frame p95 [ms]", 8},
                             {"own loss [%]", 25, 1},
                             {"frames dropped [%]", 12.5},
                             {"feedback over media [%]", 6.25},
                             {"Jain's index", 0.8, 0.9},
                             {"others [Mbit/s]", 11},
                             {"a file of theirs [s]", 12},
                             {"two streams' ratio", 13, 1.5}});
}

TEST(FiguresOfRuns, AreBetterByMoreThanWhatIsIgnored) {
  const FigureKind rate{"rate", true, 1, 0.1};
  const FigureKind delay{"delay", false, 2, 0};
  EXPECT_DOUBLE_EQ((Figure{&rate, 14}).BetterThan({&rate, 10}), 2);
  EXPECT_DOUBLE_EQ((Figure{&rate, 10}).BetterThan({&rate, -10}), 10);
  EXPECT_DOUBLE_EQ((Figure{&delay, 14}).BetterThan({&delay, 10}), -2);
}

TEST(FiguresOfRuns, ReachTheirGoals) {
  const FigureKind rate{"rate", true};
  const FigureKind delay{"delay", false};
  EXPECT_TRUE((Figure{&rate, 1}).reached());
  for (const double value : {1., 2., 3.}) {
    EXPECT_EQ((Figure{&rate, value, 2}).reached(), value >= 2);
    EXPECT_EQ((Figure{&delay, value, 2}).reached(), value <= 2);
  }
}

}  // namespace
}  // namespace lidar::scream::test
