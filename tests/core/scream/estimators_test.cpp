// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests what the estimators forget, and which packets they ignore.
#include <gtest/gtest.h>

#include "src/scream/model/ecn_monitor.h"
#include "src/scream/model/flight.h"
#include "src/scream/model/loss_context.h"
#include "src/scream/model/queue_delay.h"
#include "src/scream/model/rtt.h"
#include "tests/core/scream/measured_path.h"

namespace lidar::scream {
namespace {

constexpr SenderState kSender{DataSize::Bytes(10000), 20ms};

TEST(PathModel, KnowsNothingOfAnotherRoute) {
  const Parameters p;
  Path path(p);
  for (int i = 0; i < 10000; ++i)  // few marks behind a long queue
    path.Arrive(1, 1ms, 5ms + i % 20 * 1ms, i % 50 == 0 ? Ecn::kCe : Ecn::kEct1);
  AckSummary loss;
  loss.lost.emplace_back();
  path.model.OnReport(path.now, loss, kSender);
  path.Arrive(1, 1ms, 5ms, Ecn::kCe);
  ASSERT_TRUE(path.model.newest_marked());
  ASSERT_TRUE(path.model.classic_ecn().found());
  ASSERT_TRUE(path.model.L4sWorks(path.now));
  const auto estimated_capacity = [&path] {
    Statistics s;
    path.model.Describe(path.now, &s);
    return s.estimated_capacity;
  };
  ASSERT_GT(estimated_capacity(), DataRate());
  ASSERT_GT(path.model.loss_rate(), 0);
  ASSERT_GT(path.model.l4s_alpha().value(), 0);
  ASSERT_NE(path.model.marking_onset(), p.pacing_reserve);

  path.model.Reset(path.now);
  EXPECT_FALSE(path.model.classic_ecn().found());
  EXPECT_FALSE(path.model.L4sWorks(path.now));
  EXPECT_FALSE(path.model.MarkedLately(path.now));
  EXPECT_FALSE(path.model.newest_marked());
  EXPECT_EQ(path.model.ecn().state(), EcnState::kTesting);
  EXPECT_EQ(estimated_capacity(), DataRate());
  EXPECT_EQ(path.model.measured_capacity(), DataRate());
  EXPECT_EQ(path.model.busy_run().packets(), 0);
  EXPECT_FALSE(path.model.busy_run().latest_capacity());
  EXPECT_FALSE(path.model.rtt().known());
  EXPECT_EQ(path.model.loss_rate(), 0);
  EXPECT_EQ(path.model.l4s_alpha().value(), 0);
  EXPECT_EQ(path.model.marking_onset(), p.pacing_reserve);
  EXPECT_EQ(path.model.report_gap(), Duration{0});
}

TEST(PathModel, KnowsNoQueueAndNoOtherFlowOfAnotherRoute) {
  const Parameters p;
  Path path(p);
  for (int i = 0; i < 20; ++i) {  // loses the packets that find the longest queue
    path.Arrive(20, 1ms, 0ms, Ecn::kEct1);
    path.Arrive(1, 1ms, 20ms, Ecn::kEct1);
    AckSummary loss;
    loss.lost.emplace_back();
    loss.lost.back().sent = path.now - kRtt - 20ms;
    path.model.OnReport(path.now, loss, kSender);
  }
  path.Arrive(120, 100ms, 50ms, Ecn::kEct1);  // The delay never falls, as if the clocks drifted.
  for (int report = 0; report < 10; ++report) {
    AckSummary marks;
    for (int packet = 0; packet < 10; ++packet) {
      path.now += 10ms;
      marks.acked.emplace_back();
      marks.acked.back().sent = path.now - kRtt - 100ms;
      marks.acked.back().arrival = marks.report = path.now - kRtt / 2;
      marks.acked.back().arrived_ecn = Ecn::kCe;
    }
    path.model.OnReport(path.now, marks, kSender);
  }
  ASSERT_TRUE(path.model.loss_context().AtFullQueue());
  ASSERT_GT(path.model.half_rate_until(), Time{});
  ASSERT_TRUE(path.model.cross_traffic().unseen());
  ASSERT_GT(path.model.queue_delay().qdelay_avg(), Duration{0});

  path.model.Reset(path.now);
  EXPECT_FALSE(path.model.loss_context().AtFullQueue());
  EXPECT_EQ(path.model.half_rate_until(), Time{});
  EXPECT_FALSE(path.model.cross_traffic().unseen());
  EXPECT_EQ(path.model.queue_delay().qdelay(), Duration{0});
  EXPECT_EQ(path.model.queue_delay().qdelay_avg(), Duration{0});
  EXPECT_FALSE(path.model.evidence().Counts(path.now - 1ms)) << "it left by the old route";
}

TEST(PathModel, DescribesEachMeasurementAsItIs) {
  const Parameters p;
  Path path(p);
  path.Arrive(50, 1ms, 0ms, Ecn::kEct1);
  for (int i = 0; i < 40; ++i) path.Arrive(1, 5ms, 30ms, i % 4 == 0 ? Ecn::kCe : Ecn::kEct1);
  AckSummary loss;
  loss.lost.emplace_back();
  path.model.OnReport(path.now, loss, kSender);
  path.model.OnSent(path.now, DataSize::Bytes(777), Ecn::kEct1, DataSize());
  Statistics s;
  path.model.Describe(path.now, &s);
  EXPECT_EQ(s.s_rtt, path.model.rtt().smoothed());
  EXPECT_EQ(s.min_rtt, kRtt);
  EXPECT_GT(s.s_rtt, s.min_rtt);
  EXPECT_EQ(s.qdelay, Duration(30ms));
  EXPECT_EQ(s.qdelay_avg, path.model.queue_delay().qdelay_avg());
  EXPECT_GT(s.qdelay_avg, Duration{0});
  EXPECT_LT(s.qdelay_avg, s.qdelay);
  EXPECT_EQ(s.l4s_alpha, path.model.l4s_alpha().value());
  EXPECT_GT(s.l4s_alpha, 0);
  EXPECT_EQ(s.loss_rate, path.model.loss_rate());
  EXPECT_GT(s.loss_rate, 0);
  EXPECT_EQ(s.ref_wnd_delay_scale, path.model.queue_delay().ref_wnd_delay_scale());
  EXPECT_EQ(s.acked_bitrate, path.model.acked_rate(path.now));
  EXPECT_GT(s.acked_bitrate, DataRate());
  EXPECT_EQ(s.sent_bitrate.bits_per_second(), 777 * 8 / 0.01) << "over 10 ms at least";
  EXPECT_GE(s.estimated_capacity, path.model.measured_capacity());
  EXPECT_EQ(s.cross_traffic, 0);
  EXPECT_EQ(s.clock_resets, 0U);
  EXPECT_EQ(s.ecn_state, EcnState::kCapable);
}

TEST(PathModel, DescribesNoRoundTripBeforeTheFirst) {
  const Parameters p;
  const PathModel model(p);
  Statistics s;
  model.Describe(kStart, &s);
  EXPECT_EQ(s.s_rtt, Duration{0});
  EXPECT_EQ(s.min_rtt, Duration{0});
  EXPECT_EQ(s.sent_bitrate, DataRate());
  EXPECT_EQ(s.acked_bitrate, DataRate());
  EXPECT_EQ(s.estimated_capacity, DataRate());
}

TEST(PathModel, AveragesLossesByTheDraftsFilter) {
  const Parameters p = Parameters::Draft();
  PathModel model(p);
  AckSummary acks;
  acks.lost.emplace_back();
  model.OnReport(kStart, acks, kSender);
  EXPECT_DOUBLE_EQ(model.loss_rate(), 0.0025);
  acks.lost.clear();
  acks.acked.emplace_back();
  model.OnReport(kStart, acks, {DataSize::Bytes(1000000), 20ms});
  EXPECT_DOUBLE_EQ(model.loss_rate(), 0.0025 * (1 - 0.0005));
}

TEST(PathModel, FindsTheShortestQueuesThatAreMarked) {
  const Parameters p;
  Path path(p);
  for (int i = 0; i < 1000; ++i) path.Arrive(1, 1ms, 1ms + i % 10 * 1ms, Ecn::kCe);
  EXPECT_NEAR(Milliseconds(path.model.marking_onset()), 4, 0.5);
  path.Arrive(1000, 1ms, 1ms, Ecn::kCe);
  EXPECT_NEAR(Milliseconds(path.model.marking_onset()), 1, 0.1);
}

TEST(PathModel, SeesTheNewestMarkWithoutAnArrivalTime) {
  const Parameters p;
  Path path(p);
  path.Arrive(1, 1ms, 5ms, Ecn::kEct1);
  AckSummary acks;
  acks.acked.emplace_back();
  acks.acked.back().sent = path.now;
  acks.acked.back().arrived_ecn = Ecn::kCe;
  path.model.OnReport(path.now, acks, kSender);
  EXPECT_TRUE(path.model.newest_marked());
}

TEST(PathModel, TakesNothingFromPacketsOfTheOldRoute) {
  const Parameters p;
  Path path(p);
  path.Arrive(5, 1ms, 5ms, Ecn::kEct1);
  path.model.Reset(path.now);
  AckSummary late;
  late.late_ce.push_back(path.now - 20ms);
  path.model.OnReport(path.now, late, kSender);
  // The last of these packets was sent 25 ms before the new route.
  path.Arrive(20, 1ms, 5ms, Ecn::kCe);
  EXPECT_FALSE(path.model.MarkedLately(path.now));
  EXPECT_FALSE(path.model.L4sWorks(path.now));
  EXPECT_EQ(path.model.ecn().state(), EcnState::kTesting);

  path.Arrive(100, 1ms, 5ms, Ecn::kCe);
  EXPECT_TRUE(path.model.MarkedLately(path.now));
  EXPECT_EQ(path.model.ecn().state(), EcnState::kCapable);
}

TEST(PathModel, TheRateIsHalvedWhereClocksDriftAndWholeOnAnotherRoute) {
  const Parameters p;
  Path path(p);
  for (int i = 0; i < 5000 && path.model.half_rate_until() == Time{}; ++i)
    path.Arrive(1, 10ms, 40ms, Ecn::kEct1);
  // The half rate lasts for five round trips. This is longer than its minimum, 0.2 s.
  EXPECT_GT(path.model.half_rate_until(), path.now + 350ms);
  EXPECT_LT(path.model.half_rate_until(), path.now + 450ms);
  path.model.Reset(path.now);
  EXPECT_EQ(path.model.half_rate_until(), Time{});
}

TEST(PathModel, APacketOfWhichNobodyTellsWhenItArrivedEndsABusyRun) {
  const Parameters p;
  Path path(p);
  path.Arrive(10, 1ms, 20ms, Ecn::kCe);
  ASSERT_EQ(path.model.busy_run().packets(), 10);
  AckSummary acks;
  acks.acked.emplace_back();
  acks.acked.back().sent = path.now - kRtt;
  acks.acked.back().size = kPacket;
  path.model.OnReport(path.now, acks, kSender);
  EXPECT_EQ(path.model.busy_run().packets(), 0);
}

TEST(PathModel, BelievesInMarksForHalfAMinute) {
  const Parameters p;
  Path path(p);
  path.Arrive(1, 1ms, 3ms, Ecn::kCe);
  EXPECT_TRUE(path.model.L4sWorks(path.now + 29s));
  EXPECT_FALSE(path.model.L4sWorks(path.now + 30s));
}

TEST(PathModel, PacketsThatMetAGapSayNothingOfTheLinkBehindIt) {
  const Parameters p;
  Path path(p);
  const Duration onset = path.model.marking_onset();
  path.model.OnGapEnd(path.now + 1h, 5ms, 0.25);
  EXPECT_EQ(path.model.rtt().smoothed(), kRtt) << "no shorter than the shortest";
  EXPECT_EQ(path.model.l4s_alpha().value(), 0.25);
  for (int i = 0; i < 10000; ++i)
    path.Arrive(1, 1ms, 5ms + i % 20 * 1ms, i % 50 == 0 ? Ecn::kCe : Ecn::kEct1);
  EXPECT_FALSE(path.model.classic_ecn().found());
  EXPECT_EQ(path.model.marking_onset(), onset);
}

TEST(MaxBytesInFlight, IsThatOfTheLastTenRoundTripsAndOfThisOne) {
  MaxBytesInFlight flight;
  flight.Add(DataSize::Bytes(9000));
  EXPECT_EQ(flight.longest().bytes(), 9000);
  flight.Update(kStart, 40ms);
  flight.Update(kStart + 39ms, 40ms);
  EXPECT_EQ(flight.previous().bytes(), 9000);
  EXPECT_EQ(flight.current().bytes(), 0);
  for (int i = 1; i <= 9; ++i) flight.Update(kStart + i * 40ms, 40ms);
  EXPECT_EQ(flight.longest().bytes(), 9000);
  flight.Update(kStart + 400ms, 40ms);
  EXPECT_EQ(flight.longest().bytes(), 0);
}

TEST(EcnMonitor, CountsUnansweredPacketsFromTheLastAnswerOn) {
  EcnMonitor ecn(Ecn::kEct1);
  for (int i = 0; i < 9; ++i) ecn.OnSent(kStart, Ecn::kEct1);
  ecn.OnAcked(Ecn::kEct1, Ecn::kNotEct);
  for (int i = 0; i < 9; ++i) ecn.OnSent(kStart + 3s, Ecn::kEct1);
  ecn.OnTimer(kStart + 10s);
  ecn.OnSent(kStart + 10s, Ecn::kEct1);
  EXPECT_EQ(ecn.codepoint(), Ecn::kEct1);
  ecn.OnTimer(kStart + 10s);
  ecn.OnSent(kStart + 10s, Ecn::kEct1);
  EXPECT_EQ(ecn.codepoint(), Ecn::kNotEct);
}

TEST(EcnMonitor, BeginsToCountAnewOnAnotherRoute) {
  EcnMonitor ecn(Ecn::kEct1);
  for (int i = 0; i < 19; ++i) ecn.OnAcked(Ecn::kEct1, Ecn::kNotEct);
  for (int i = 0; i < 9; ++i) ecn.OnSent(kStart, Ecn::kEct1);
  ecn.Reset();
  ecn.OnSent(kStart + 5s, Ecn::kEct1);
  ecn.OnTimer(kStart + 10s);
  ecn.OnSent(kStart + 10s, Ecn::kEct1);
  EXPECT_EQ(ecn.codepoint(), Ecn::kEct1);
  ecn.OnAcked(Ecn::kEct1, Ecn::kNotEct);
  EXPECT_EQ(ecn.state(), EcnState::kTesting);
}

TEST(LossContext, KnowsNothingOfTheFirstPackets) {
  LossContext context;
  const auto lose = [&context](int frame) {  // loses the last packet of ten
    const Time start = kStart + frame * 20ms;
    for (int i = 0; i < 9; ++i) context.OnAcked(start + i * 1ms, i * 300us);
    context.OnLost(start + 9ms);
  };
  for (int frame = 0; frame < 15; ++frame) lose(frame);
  EXPECT_FALSE(context.AtFullQueue());
  for (int frame = 15; frame < 40; ++frame) lose(frame);
  EXPECT_TRUE(context.AtFullQueue());
}

TEST(QueueDelay, AWayBackThatTakesLongForAWhileIsNoClock) {
  const Parameters p;
  QueueDelay delay(p);
  for (const Time now : {kStart, kStart + 1s})
    EXPECT_TRUE(delay.Add(now, {now - 40ms, now - 20ms, 0ms, 20ms}));
  const Time later = kStart + 6min;  // By then the shortest way back is forgotten.
  EXPECT_TRUE(delay.Add(later, {later - 240ms, later - 220ms, 200ms, 220ms}));
  EXPECT_TRUE(delay.Add(later, {later - 40ms, later - 20ms, 0ms, 20ms}));
}

TEST(QueueDelay, WhereMarksKeepTheQueueShortAHigherBaseIsBelievedWithinHalfAMinute) {
  for (const bool marked : {true, false}) {
    const Parameters p;
    QueueDelay delay(p);
    const auto add = [&](Time now, Duration owd) {
      delay.Add(now, {now - 100ms, now - 100ms + owd, 0ms, 100ms - owd}, marked);
    };
    add(kStart, 20ms);
    for (Time now = kStart + 1s; now <= kStart + 40s; now += 1s) add(now, 35ms);
    EXPECT_EQ(delay.qdelay(), marked ? Duration(0ms) : Duration(15ms)) << marked;
  }
}

TEST(QueueDelay, ASecondJumpIsSeenToo) {
  const Parameters p;
  QueueDelay delay(p);
  const auto add = [&delay](Time now, Duration owd) {
    return delay.Add(now, {now - 50ms, now - 50ms + owd, 0ms, 40ms - owd});
  };
  for (Time now = kStart; now < kStart + 1s; now += 100ms) EXPECT_TRUE(add(now, 20ms));
  EXPECT_FALSE(add(kStart + 1s, -3000ms));
  EXPECT_TRUE(add(kStart + 1100ms, -3000ms));
  EXPECT_FALSE(add(kStart + 2s, -2000ms));
}

TEST(RoundTripTime, IsAMillisecondAtLeast) {
  RoundTripTime rtt;
  rtt.Add(kStart, 0ms);
  EXPECT_EQ(rtt.smoothed(), Duration(1ms));
  EXPECT_EQ(rtt.min(), Duration(1ms));
}

TEST(RoundTripTime, TheShortestIsRememberedForHalfAMinuteAtLeast) {
  RoundTripTime rtt;
  rtt.Add(kStart, 40ms);
  rtt.Add(kStart + 31s, 80ms);
  EXPECT_EQ(rtt.min(), Duration(40ms));
  rtt.Add(kStart + 62s, 80ms);
  EXPECT_EQ(rtt.min(), Duration(80ms));
}

}  // namespace
}  // namespace lidar::scream
