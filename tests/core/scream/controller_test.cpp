// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests the whole controller: first by calling its functions, then on a simulated path.
#include "src/scream/controller.h"

#include <gtest/gtest.h>

#include <deque>

#include "src/rtcp/report_clock.h"
#include "src/sim/scenarios.h"
#include "src/sim/simulated_time.h"

namespace lidar::scream::test {
namespace {

TEST(Controller, StartsAtTheStartBitrate) {
  Controller c{Parameters()};
  const StreamId id = c.AddStream({1, Mbps(0.1), Mbps(3), Mbps(10)});
  EXPECT_NEAR(c.target_bitrate(id).bits_per_second(), 3e6, 1);
  EXPECT_FALSE(c.NextSend(kStart));
  EXPECT_EQ(c.NextTimer(), Time::max());
}

TEST(Controller, ClosesTheWindowWithoutFeedbackButKeepsAMinimumRate) {
  Controller c{Parameters()};
  const StreamId id = c.AddStream({1, Mbps(0.1), Mbps(1), Mbps(10)});
  Time now = kStart;
  const auto queue = [&] { c.OnQueued(now, id, {1, DataSize::Bytes(1000), true, 0}); };
  for (int i = 0; i < 200; ++i) queue();
  Duration longest{0};
  for (std::uint16_t seq = 0; seq < 100; ++seq) {
    const auto d = c.NextSend(now);
    ASSERT_TRUE(d);
    longest = std::max(longest, d->time - now);
    now = std::max(now, d->time);
    c.OnSent(now, id, {1, seq, DataSize::Bytes(1000), d->ecn});
  }
  EXPECT_EQ(longest, Duration(160ms));  // the time of 1000 bytes at RATE_PACE_MIN
}

TEST(Controller, WantsTheTimerWhilePacketsWaitOrAreUnderWay) {
  Controller c{Parameters()};
  const StreamId id = c.AddStream({1, Mbps(0.1), Mbps(1), Mbps(10)});
  c.OnQueued(kStart, id, {1, DataSize::Bytes(1000), true, 0});
  EXPECT_LE(c.NextTimer(), kStart);
  c.OnTimer(kStart);
  EXPECT_EQ(c.NextTimer(), kStart + 50ms);
  c.OnSent(kStart, id, {1, 0, DataSize::Bytes(1000), Ecn::kEct1});
  EXPECT_EQ(c.NextTimer(), kStart + 50ms);
  c.OnRouteChange(kStart + 1ms);  // forgets the packets in flight
  EXPECT_EQ(c.NextTimer(), Time::max());
}

TEST(Controller, TakesOnlyItsCallersSilenceForAStandstill) {
  Controller c{Parameters()};
  const StreamId id = c.AddStream({1, Mbps(0.1), Mbps(1), Mbps(10)});
  c.OnQueued(kStart, id, {1, DataSize::Bytes(1000), true, 0});
  c.OnSent(kStart, id, {1, 0, DataSize::Bytes(1000), Ecn::kEct1});
  // The thread that would call OnTimer() is stuck, while the other threads continue.
  Time now = kStart;
  for (int i = 0; i < 100; ++i) c.OnQueued(now += 12ms, id, {1, DataSize::Bytes(1000), true, 0});
  EXPECT_EQ(c.statistics(now).bytes_in_flight.bytes(), 1000);
  c.OnQueued(now += 1s, id, {1, DataSize::Bytes(1000), true, 0});
  EXPECT_EQ(c.statistics(now).bytes_in_flight.bytes(), 0);
}

TEST(Controller, ExpectsNothingOfAnOldRoute) {
  Controller c{Parameters()};
  const StreamId id = c.AddStream({1, Mbps(0.1), Mbps(1), Mbps(10)});
  c.OnQueued(kStart, id, {1, DataSize::Bytes(1000), true, 0});
  c.OnSent(kStart, id, {1, 0, DataSize::Bytes(1000), Ecn::kEct1});
  c.OnRouteChange(kStart + 1ms);
  EXPECT_EQ(c.statistics(kStart + 1ms).bytes_in_flight.bytes(), 0);
}

TEST(Controller, RestartsFromTheStartBitrateOnANewRoute) {
  Controller c{Parameters()};
  const StreamId id = c.AddStream({1, Mbps(0.1), Mbps(1), Mbps(50)});
  const DataSize size = DataSize::Bytes(1200);
  Time now = kStart;
  std::uint16_t seq = 0, reported = 0;
  std::deque<Time> under_way;  // the sending times of the packets from number `reported` on
  DataSize due;
  // The stream sends at its target in frames of 20 ms, and each packet is reported after 30 ms.
  const auto run = [&](Duration time, Ecn ecn = Ecn::kEct1) {
    for (const Time end = now + time; now < end; now += 20ms) {
      rtcp::CongestionFeedback report;
      report.report_timestamp = rtcp::ReportClock::ToTimestamp(now);
      report.blocks.push_back({1, reported, {}});
      for (; !under_way.empty() && now - under_way.front() >= 30ms; ++reported) {
        report.blocks[0].metrics.push_back({true, ecn, 0ms});
        under_way.pop_front();
      }
      if (!report.blocks[0].metrics.empty()) {
        EXPECT_EQ(c.OnFeedback(now, report), FeedbackResult::kAccepted);
      }
      c.OnTimer(now);
      for (due += c.target_bitrate(id) * 20ms; due > size; due -= size) {
        const bool last = due - size <= size;
        c.OnQueued(now, id,
                   {1, size, last, static_cast<std::uint32_t>(Seconds(now - kStart) * 9e4)});
        c.OnSent(now, id, {1, seq++, size, Ecn::kEct1});
        under_way.push_back(now);
      }
    }
  };
  run(5s);
  ASSERT_GT(c.target_bitrate(id), Mbps(8));
  run(100ms, Ecn::kCe);
  c.OnRouteChange(now);
  under_way.clear();
  reported = seq;
  run(40ms);  // No report arrives in this time.
  EXPECT_LT(c.target_bitrate(id), Mbps(2));
  run(200ms);
  EXPECT_EQ(c.statistics(now).loss_events, 0U) << "packets of the old route are not lost";
  EXPECT_GT(c.target_bitrate(id), Mbps(3)) << "it grows as at the start, in spite of the marks";
}

TEST(Controller, ShowsWhatWaitsAndWhatItAimsAt) {
  Parameters p;
  p.qdelay_target_lo = 33ms;
  Controller c{p};
  const StreamId a = c.AddStream({1, Mbps(0.1), Mbps(1), Mbps(10)});
  const StreamId b = c.AddStream({1, Mbps(0.1), Mbps(3), Mbps(10)});
  c.OnQueued(kStart, a, {11, DataSize::Bytes(1000), true, 0});
  for (int i = 0; i < 2; ++i) c.OnQueued(kStart + 5ms, b, {22, DataSize::Bytes(700), true, 0});
  c.OnSent(kStart + 5ms, b, {22, 0, DataSize::Bytes(700), Ecn::kEct1});
  c.OnDropped(kStart + 5ms, b, 1);
  const Statistics s = c.statistics(kStart + 25ms);
  EXPECT_EQ(s.qdelay_target, Duration(33ms));
  EXPECT_EQ(s.queued.bytes(), 1000);
  EXPECT_EQ(s.media_qdelay, Duration(25ms));
  EXPECT_EQ(s.bytes_in_flight.bytes(), 700);
  EXPECT_EQ(s.packets_sent, 1U);
  EXPECT_EQ(s.bytes_sent.bytes(), 700);
  EXPECT_EQ(s.packets_dropped, 1U);
  EXPECT_NEAR(s.target_bitrate.bits_per_second(), 4e6, 1);
  EXPECT_GE(s.pace_bitrate, s.target_bitrate);
  EXPECT_GE(s.ref_wnd, p.min_ref_wnd);
  EXPECT_EQ(s.reason, RateReason::kStart);
  const StreamStatistics of_a = c.stream_statistics(kStart + 25ms, a);
  EXPECT_EQ(of_a.queued.bytes(), 1000);
  EXPECT_EQ(of_a.media_qdelay, Duration(25ms));
  EXPECT_EQ(of_a.target_bitrate, c.target_bitrate(a));
  EXPECT_EQ(of_a.packets_sent, 0U);
  const StreamStatistics of_b = c.stream_statistics(kStart + 25ms, b);
  EXPECT_EQ(of_b.packets_sent, 1U);
  EXPECT_EQ(of_b.packets_dropped, 1U);
  EXPECT_EQ(of_b.bytes_sent.bytes(), 700);
  EXPECT_GT(of_b.sent_bitrate, DataRate());
  c.RemoveStream(a);
  EXPECT_EQ(c.stream_statistics(kStart + 25ms, a).target_bitrate, DataRate());
  EXPECT_EQ(c.target_bitrate(a), DataRate());
}

TEST(Controller, FindsTheStreamOfASource) {
  Controller c{Parameters()};
  const StreamId a = c.AddStream({}), b = c.AddStream({});
  c.OnQueued(kStart, a, {11, DataSize::Bytes(1000), true, 0});
  c.OnQueued(kStart, b, {22, DataSize::Bytes(1000), true, 0});
  EXPECT_EQ(c.FindStream(22), b);
  EXPECT_EQ(c.FindStream(11), a);
  EXPECT_FALSE(c.FindStream(33));
}

TEST(Controller, KnowsTheSourceOfAPacketThatItSawLeaveOnly) {
  Controller c{Parameters()};
  const StreamId a = c.AddStream({});
  c.AddStream({});
  c.OnSent(kStart, a, {99, 0, DataSize::Bytes(1000), Ecn::kEct1});  // for example a repair packet
  EXPECT_EQ(c.FindStream(99), a);
}

TEST(Controller, FollowsANewConfigurationAtOnce) {
  Controller c{Parameters()};
  const StreamId id = c.AddStream({1, Mbps(0.1), Mbps(1), Mbps(10)});
  c.ConfigureStream(id, {1, Mbps(4), Mbps(1), Mbps(10)});
  EXPECT_GE(c.target_bitrate(id), Mbps(4));
}

TEST(Controller, TellsAsOfTheLatestTimeThatItKnows) {
  Controller c{Parameters()};
  const StreamId id = c.AddStream({});
  Time now = kStart;
  for (std::uint16_t seq = 0; seq < 10; ++seq, now += 50ms)
    c.OnSent(now, id, {1, seq, DataSize::Bytes(1000), Ecn::kEct1});
  EXPECT_EQ(c.statistics(kStart + 100ms).sent_bitrate, c.statistics(now - 50ms).sent_bitrate);
}

TEST(Controller, SendsWithoutEcnWhereOnlyThatComesThrough) {
  Controller c{Parameters()};
  const StreamId id = c.AddStream({1, Mbps(0.1), Mbps(1), Mbps(10)});
  Time now = kStart;
  for (std::uint16_t seq = 0; seq < 60; ++seq) {
    c.OnQueued(now, id, {1, DataSize::Bytes(1000), true, 0});
    const auto d = c.NextSend(now);
    ASSERT_TRUE(d);
    now = std::max(now, d->time);
    c.OnTimer(now);
    c.OnSent(now, id, {1, seq, DataSize::Bytes(1000), d->ecn});
    now += 100ms;
    if (d->ecn != Ecn::kNotEct) continue;
    rtcp::CongestionFeedback f;
    f.report_timestamp = rtcp::ReportClock::ToTimestamp(now - 50ms);
    f.blocks.push_back({1, seq, {{true, Ecn::kNotEct, 0ms}}});
    ASSERT_EQ(c.OnFeedback(now, f), FeedbackResult::kAccepted);
  }
  EXPECT_EQ(c.ecn_state(), EcnState::kSilent);
}

/// A link of 8 Mbit/s with an RTT of 40 ms, which is full. From the time `now_` on, it delivers
/// nothing.
class FullLink : public ::testing::Test {
 protected:
  FullLink() {
    for (now_ = kStart; now_ < kStart + 2s; now_ += kTick) {
      if (now_ >= kStart + 40ms) Report(now_ - 40ms);
      for (int i = 0; i < kPacketsATick; ++i)
        c_.OnSent(now_, id_, {1, seq_++, DataSize::Bytes(1000), Ecn::kEct1});
    }
  }
  /// Reports that all packets sent until `sent` have arrived. The last packet arrived half a round
  /// trip after it was sent.
  void Report(Time sent) {
    const auto until = static_cast<std::uint16_t>(((sent - kStart) / kTick + 1) * kPacketsATick);
    ReportNext(static_cast<std::uint16_t>(until - reported_), Ecn::kEct1, sent + 20ms, 0ms);
  }
  /// Reports the next `count` packets. They arrived 1 ms apart, the last one half a round trip ago.
  void ReportTrain(int count, Ecn ecn) { ReportNext(count, ecn, now_ - 20ms, 1ms); }
  /// Reports the next `count` packets. They arrived `apart` from each other, the last one at
  /// `last`.
  void ReportNext(int count, Ecn ecn, Time last, Duration apart) {
    rtcp::CongestionFeedback f;
    f.report_timestamp = rtcp::ReportClock::ToTimestamp(last);
    f.blocks.push_back({1, reported_, {}});
    for (int i = 1; i <= count; ++i)
      f.blocks[0].metrics.push_back({true, ecn, (count - i) * apart});
    reported_ = static_cast<std::uint16_t>(reported_ + count);
    ASSERT_EQ(c_.OnFeedback(now_, f), FeedbackResult::kAccepted);
  }
  /// Sends five trains of three packets over an empty path, and reports each train.
  void SendAfresh() {
    reported_ = seq_;
    for (int train = 0; train < 5; ++train, now_ += 50ms) {
      for (int i = 0; i < 3; ++i)
        c_.OnSent(now_, id_, {1, seq_++, DataSize::Bytes(1000), Ecn::kEct1});
      now_ += 40ms;
      ReportNext(3, Ecn::kEct1, now_ - 20ms, 0ms);
    }
  }
  void QueueFrame() { c_.OnQueued(now_, id_, {1, DataSize::Bytes(1000), true, 7}); }

  static constexpr Duration kTick = 10ms;
  static constexpr int kPacketsATick = 10;
  Controller c_{Parameters()};
  const StreamId id_ = c_.AddStream({1, Mbps(0.1), Mbps(8), Mbps(10)});
  Time now_ = kStart;
  std::uint16_t seq_ = 0, reported_ = 0;
};

TEST_F(FullLink, AFrameBehindWhatMetAGapMayWaitForThatToo) {
  QueueFrame();
  EXPECT_EQ(c_.LatePackets(now_ + 220ms, id_), 0U);
  EXPECT_EQ(c_.LatePackets(now_ + 260ms, id_), 1U);
}

TEST_F(FullLink, AFrameBehindNothingMayNot) {
  Report(now_ - kTick);
  QueueFrame();
  EXPECT_EQ(c_.LatePackets(now_ + 200ms, id_), 0U);
  EXPECT_EQ(c_.LatePackets(now_ + 201ms, id_), 1U);
}

TEST_F(FullLink, AFrameBehindFreshPacketsMayNot) {
  Report(now_ - kTick);
  QueueFrame();
  const StreamId other = c_.AddStream({});
  for (int i = 0; i < 50; ++i)
    c_.OnSent(now_ + 190ms, other, {1, seq_++, DataSize::Bytes(1000), Ecn::kEct1});
  EXPECT_EQ(c_.LatePackets(now_ + 200ms, id_), 0U);
  EXPECT_EQ(c_.LatePackets(now_ + 201ms, id_), 1U);
}

TEST_F(FullLink, WaitsNoShorterOnceWhatMetAGapArrives) {
  QueueFrame();
  now_ += 225ms;
  ASSERT_EQ(c_.LatePackets(now_, id_), 0U);
  ReportTrain(16, Ecn::kEct1);
  EXPECT_EQ(c_.LatePackets(now_, id_), 0U);
}

TEST_F(FullLink, AMarkOfAGapIsNotObeyedAfterIt) {
  now_ += 300ms;
  ReportTrain(1, Ecn::kCe);
  now_ += 8ms;
  ReportTrain(20, Ecn::kCe);
  const Statistics restarted = c_.statistics(now_);
  ASSERT_EQ(restarted.gaps, 1U);
  now_ += 44ms;
  ReportTrain(10, Ecn::kEct1);
  EXPECT_EQ(c_.statistics(now_).ce_events, restarted.ce_events);
  EXPECT_GE(c_.statistics(now_).ref_wnd, restarted.ref_wnd);
}

TEST_F(FullLink, AGapOfTheOldRouteGivesNothingBackOnTheNewOne) {
  now_ += 300ms;
  ReportTrain(1, Ecn::kCe);  // A gap of the link delayed this packet.
  c_.OnRouteChange(now_);
  SendAfresh();
  EXPECT_EQ(c_.statistics(now_).gaps, 0U);
}

TEST_F(FullLink, AGapInWhichTheMachineStoodStillGivesNothingBack) {
  now_ += 300ms;
  ReportTrain(1, Ecn::kCe);  // A gap of the link delayed this packet.
  now_ += 1s;
  c_.OnTimer(now_);
  ASSERT_EQ(c_.statistics(now_).bytes_in_flight.bytes(), 0);
  SendAfresh();
  EXPECT_EQ(c_.statistics(now_).gaps, 0U);
}

TEST_F(FullLink, WaitsForAllThatIsInFlightForHalfOfTheDelayAtMost) {
  for (int i = 0; i < 1000; ++i)
    c_.OnSent(now_, id_, {1, seq_++, DataSize::Bytes(1000), Ecn::kEct1});
  QueueFrame();
  EXPECT_EQ(c_.LatePackets(now_ + 300ms, id_), 0U);
  EXPECT_EQ(c_.LatePackets(now_ + 301ms, id_), 1U);
}

TEST_F(FullLink, APauseOfTheSourceIsNoSilenceOfTheReceiver) {
  Report(now_ - kTick);
  now_ += 10s;
  c_.OnSent(now_, id_, {1, seq_++, DataSize::Bytes(1000), Ecn::kEct1});
  c_.OnTimer(now_);
  EXPECT_EQ(c_.statistics(now_).feedback_timeouts, 0U);
}

/// If one packet was very late, the controller still waits for another packet no longer than a
/// round trip.
TEST(Controller, WaitsForAPacketNoLongerThanARoundTrip) {
  Controller c{Parameters()};
  const StreamId id = c.AddStream({});
  for (std::uint16_t seq = 0; seq < 9; ++seq)
    c.OnSent(kStart, id, {1, seq, DataSize::Bytes(1000), Ecn::kEct1});
  const auto report = [&](Time now, const std::string& metrics) {
    rtcp::CongestionFeedback f;
    f.report_timestamp = rtcp::ReportClock::ToTimestamp(now);
    f.blocks.push_back({1, 0, {}});
    // All packets that arrived have the same arrival time, kStart + 10 ms.
    for (const char m : metrics)
      f.blocks[0].metrics.push_back({m == 'r', Ecn::kEct1, now - kStart - 10ms});
    ASSERT_EQ(c.OnFeedback(now, f), FeedbackResult::kAccepted);
  };
  report(kStart + 10ms, "r-r");
  EXPECT_EQ(c.statistics(kStart).packets_lost, 1U);
  report(kStart + 70ms, "rrr");
  EXPECT_EQ(c.statistics(kStart).packets_late, 1U);
  report(kStart + 80ms, "rrr-r");
  EXPECT_EQ(c.statistics(kStart).packets_lost, 1U);
  report(kStart + 100ms, "rrr-rr");
  EXPECT_EQ(c.statistics(kStart).packets_lost, 2U);
}

TEST(Controller, CountsAMarkThatOnlyALaterReportHas) {
  Controller c{Parameters()};
  const StreamId id = c.AddStream({});
  c.OnSent(kStart, id, {1, 0, DataSize::Bytes(1000), Ecn::kEct1});
  for (const Ecn arrived : {Ecn::kEct1, Ecn::kCe}) {
    rtcp::CongestionFeedback f;
    f.report_timestamp = rtcp::ReportClock::ToTimestamp(kStart + 20ms);
    f.blocks.push_back({1, 0, {{true, arrived, 10ms}}});
    ASSERT_EQ(c.OnFeedback(kStart + 30ms, f), FeedbackResult::kAccepted);
    EXPECT_EQ(c.statistics(kStart + 30ms).packets_ce, arrived == Ecn::kCe ? 1U : 0U);
  }
}

TEST(Controller, ImplausibleFeedbackChangesNothingAndIsCounted) {
  Controller c{Parameters()};
  const StreamId id = c.AddStream({});
  c.OnQueued(kStart, id, {1, DataSize::Bytes(1000), true, 0});
  c.OnSent(kStart, id, {1, 5, DataSize::Bytes(1000), Ecn::kEct1});
  rtcp::CongestionFeedback f;
  f.blocks.push_back({1, 6, {{true, Ecn::kCe, 0ms}}});
  EXPECT_EQ(c.OnFeedback(kStart + 10ms, f), FeedbackResult::kImplausible);
  f.blocks[0].ssrc = 2;
  EXPECT_EQ(c.OnFeedback(kStart + 10ms, f), FeedbackResult::kNotOurs);
  const Statistics s = c.statistics(kStart + 10ms);
  EXPECT_EQ(s.feedback_ignored, 1U);
  EXPECT_EQ(s.foreign_blocks, 1U);
  EXPECT_EQ(s.packets_ce, 0U);
  EXPECT_EQ(s.bytes_in_flight.bytes(), 1000);
}

TEST(WholeLoop, IsDeterministic) {
  SimulationConfig config = FindScenario("frames_8M_rtt40", Parameters())->config;
  config.duration = std::chrono::seconds(10);
  const SimulationResult a = Simulate(config), b = Simulate(config);
  EXPECT_EQ(a.flows[0].delivered_bytes, b.flows[0].delivered_bytes);
  EXPECT_EQ(a.packets.size(), b.packets.size());
}

TEST(Simulation, ThePureDraftHoldsTheL4sQueue) {
  const Scenario s = *FindScenario("frames_20M_rtt25", Parameters::Draft());
  const ScenarioMetrics m = Measure(s, Simulate(s.config));
  EXPECT_GT(m.utilisation, 0.6);
  EXPECT_LT(m.queue_ms.p99, 5);
  EXPECT_EQ(m.own_loss, 0);
}

TEST(Simulation, ThePureDraftFillsALinkWithoutEcn) {
  const Scenario s = *FindScenario("frames_8M_fifo100_notect", Parameters::Draft());
  const ScenarioMetrics m = Measure(s, Simulate(s.config));
  EXPECT_GT(m.utilisation, 0.95);
  EXPECT_LT(m.queue_ms.p95, 40);
}

/// Each counter counts only the signal that it is named after.
TEST(Simulation, CountsWhatItAnswers) {
  const Statistics marked =
      Simulate(FindScenario("frames_20M_rtt25", Parameters::Draft())->config).flows[0].statistics;
  EXPECT_GT(marked.ce_events, 10U);
  EXPECT_LT(marked.ce_events, 10'000U);
  EXPECT_GE(marked.packets_ce, marked.ce_events);
  EXPECT_EQ(marked.loss_events, 0U);
  EXPECT_EQ(marked.packets_lost, 0U);
  const Statistics delayed =
      Simulate(FindScenario("frames_8M_fifo100_notect", Parameters::Draft())->config)
          .flows[0]
          .statistics;
  EXPECT_GT(delayed.delay_events, 10U);
  EXPECT_LT(delayed.delay_events, 10'000U);
  EXPECT_EQ(delayed.ce_events, 0U);
  EXPECT_EQ(delayed.packets_ce, 0U);
}

TEST(Simulation, ALongerRouteIsNoCongestion) {
  const Scenario s = *FindScenario("frames_20M_longer_route", Parameters());
  const SimulationResult result = Simulate(s.config);
  const Time change = s.config.forward.origin + s.config.longer_from;
  EXPECT_GT(result.Utilisation(change, change + 20s), 0.85);
}

TEST(Simulation, AnObstinateEncoderDoesNotFillTheNetworkQueue) {
  Scenario s = *FindScenario("frames_8M_rtt40", Parameters());
  s.config.flows[0].sources[0].obedience = [](Duration t) { return t > 10s ? 2.0 : 1.0; };
  const ScenarioMetrics m = Measure(s, Simulate(s.config));
  EXPECT_LT(m.queue_ms.p99, 15);
  EXPECT_GT(m.utilisation, 0.9);
  EXPECT_LT(m.frame_ms.p95, 100);
}

TEST(Simulation, AStepMarkerAndAPairOfQueuesAreUsedToo) {
  for (const char* name : {"frames_8M_step1ms", "frames_20M_dualpi2"}) {
    const Scenario s = *FindScenario(name, Parameters());
    const ScenarioMetrics m = Measure(s, Simulate(s.config));
    EXPECT_GT(m.utilisation, 0.8) << name;
    EXPECT_LT(m.queue_ms.p99, 2) << name;
  }
}

TEST(Simulation, JitterBurstsAndReorderingCostNothing) {
  for (const char* name : {"frames_20M_jitter4", "frames_20M_bursts5", "frames_20M_reorder1"}) {
    const Scenario s = *FindScenario(name, Parameters());
    const SimulationResult result = Simulate(s.config);
    const ScenarioMetrics m = Measure(s, result);
    EXPECT_GT(m.utilisation, 0.93) << name;
    EXPECT_LT(m.queue_ms.p99, 5) << name;
    EXPECT_EQ(result.flows[0].statistics.loss_events, 0U) << name;
  }
}

TEST(Controller, BleachedPacketsAreSentAsNotEct) {
  Controller c{Parameters()};
  const StreamId id = c.AddStream({});
  Time now = kStart;
  rtcp::CongestionFeedback f;
  f.blocks.push_back({1, 0, {}});
  for (std::uint16_t seq = 0; seq < 25; ++seq, now += 5ms) {
    c.OnQueued(now, id, {1, DataSize::Bytes(1000), true, seq});
    c.OnSent(now, id, {1, seq, DataSize::Bytes(1000), c.NextSend(now)->ecn});
    f.blocks[0].metrics.push_back({true, Ecn::kNotEct, 0ms});
  }
  f.report_timestamp = 77;
  EXPECT_EQ(c.ecn_state(), EcnState::kTesting);
  EXPECT_EQ(c.OnFeedback(now, f), FeedbackResult::kAccepted);
  EXPECT_EQ(c.ecn_state(), EcnState::kBleached);
  c.OnQueued(now, id, {1, DataSize::Bytes(1000), true, 99});
  EXPECT_EQ(c.NextSend(now)->ecn, Ecn::kNotEct);
  c.OnRouteChange(now);
  EXPECT_EQ(c.ecn_state(), EcnState::kTesting);
  EXPECT_EQ(c.NextSend(now)->ecn, Ecn::kEct1);
}

TEST(Simulation, SurvivesLostFeedback) {
  Scenario s = *FindScenario("frames_8M_rtt40", Parameters());
  const double clean = Measure(s, Simulate(s.config)).utilisation;
  s.config.return_loss = 0.2;
  const SimulationResult result = Simulate(s.config);
  EXPECT_GT(Measure(s, result).utilisation, clean - 0.05);
  EXPECT_EQ(result.flows[0].statistics.packets_lost, 0U);
}

}  // namespace
}  // namespace lidar::scream::test
