// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests the constants of the draft, and the small detectors: queue delay, losses, link rate.
#include <gtest/gtest.h>

#include "src/link/random.h"
#include "src/scream/model/busy_run.h"
#include "src/scream/model/loss_context.h"
#include "src/scream/model/queue_delay.h"
#include "src/scream/model/rtt.h"
#include "src/sim/simulated_time.h"

namespace lidar::scream {
namespace {

TEST(Parameters, TheDraftColumnIsTheDrafts) {
  const Parameters p = Parameters::Draft();
  EXPECT_EQ(p.qdelay_target_lo, Duration(60ms));
  EXPECT_EQ(p.min_ref_wnd.bytes(), 3000);
  EXPECT_DOUBLE_EQ(p.bytes_in_flight_head_room, 1.5);
  EXPECT_DOUBLE_EQ(p.beta_loss, 0.7);
  EXPECT_DOUBLE_EQ(p.beta_ecn, 0.8);
  EXPECT_EQ(p.mss.bytes(), 1000);
  EXPECT_DOUBLE_EQ(p.post_congestion_delay_rtt, 100);
  EXPECT_DOUBLE_EQ(p.mul_increase_factor, 0.02);
  EXPECT_EQ(p.virtual_rtt, Duration(25ms));
  EXPECT_DOUBLE_EQ(p.l4s_avg_g, 1.0 / 16);
  EXPECT_DOUBLE_EQ(p.qdelay_avg_g, 1.0 / 4);
  EXPECT_DOUBLE_EQ(p.ref_wnd_i_update_max_hold_rtts, 50);
  EXPECT_DOUBLE_EQ(p.ref_wnd_i_update_growth, 1.05);
  EXPECT_DOUBLE_EQ(p.qdelay_min_max_avg_g, 1.0 / 16);
  EXPECT_DOUBLE_EQ(p.qdelay_dev_avg_g, 1.0 / 32);
  EXPECT_EQ(p.qdelay_dev_threshold, Duration(10ms));
  EXPECT_DOUBLE_EQ(p.ref_wnd_overhead_min, 1.5);
  EXPECT_DOUBLE_EQ(p.ref_wnd_overhead_max, 3.0);
  EXPECT_DOUBLE_EQ(p.rate_pace_min.bits_per_second(), 50e3);
  EXPECT_DOUBLE_EQ(p.packet_pacing_headroom, 1.5);
  EXPECT_DOUBLE_EQ(p.max_relaxed_pacing_factor, 4);
  EXPECT_DOUBLE_EQ(p.relaxed_pacing_limit_low, 0.8);
  EXPECT_EQ(p.packet_overhead.bytes(), 20);
  EXPECT_DOUBLE_EQ(p.rate_adjust_gain, 1.0 / 16);
  EXPECT_DOUBLE_EQ(p.frame_size_dev_alpha, 1.0 / 64);
  EXPECT_DOUBLE_EQ(p.target_rate_divisor, 1.2);
  EXPECT_DOUBLE_EQ(p.qdelay_min_avg_alpha, 1.0 / 256);
  EXPECT_DOUBLE_EQ(p.loss_rate_threshold, 0.01);
  EXPECT_DOUBLE_EQ(p.acked_bitrate_margin, 0.8);
  EXPECT_DOUBLE_EQ(p.backoff_scale_low_target_rate, 0.25);
}

TEST(Parameters, ThePureDraftHasNoOptionalPartAndNoExtension) {
  const Parameters p = Parameters::Draft();
  EXPECT_FALSE(p.reduce_jitter || p.clock_drift || p.link_layer_loss || p.undershoot_remedy);
  const Extensions& e = p.extensions;
  EXPECT_FALSE(e.capacity || e.evidence || e.gaps || e.company);
  EXPECT_EQ(p.pacing_catch_up, Duration{0});
}

class QueueDelayTest : public ::testing::Test {
 protected:
  /// Sends one packet per millisecond. Each packet arrives after `owd`. The clocks of sender and
  /// receiver differ by an hour.
  void Run(int packets, Duration owd, Duration rtt_excess) {
    for (int i = 0; i < packets; ++i, now_ += 1ms) {
      const Duration way_back = 40ms + rtt_excess - owd - 1h;
      ok_ = delay_.Add(now_, {now_ - 20ms, now_ - 20ms + owd + 1h, rtt_excess, way_back}) && ok_;
      new_base_ = delay_.Update(now_, 40ms) || new_base_;
    }
  }
  Parameters parameters_;
  QueueDelay delay_{parameters_};
  Time now_ = kStart;
  bool ok_ = true;
  bool new_base_ = false;
};

TEST_F(QueueDelayTest, IsTheDelayAboveTheLowestSeen) {
  Run(10, 20ms, 0ms);
  EXPECT_EQ(delay_.qdelay(), Duration(0));
  Run(1, 27ms, 7ms);
  EXPECT_EQ(delay_.qdelay(), Duration(7ms));
}

TEST_F(QueueDelayTest, TheAverageRisesSlowlyAndFallsAtOnce) {
  Run(30, 20ms, 0ms);
  Run(26, 60ms, 40ms);
  EXPECT_NEAR(Milliseconds(delay_.qdelay_avg()), 10, 0.01);
  Run(26, 20ms, 0ms);
  EXPECT_EQ(delay_.qdelay_avg(), Duration(0));
}

TEST_F(QueueDelayTest, AJumpThatTheRoundTripDoesNotShowIsAClockAndNotAQueue) {
  Run(30, 20ms, 0ms);
  Run(1, 3020ms, 0ms);
  EXPECT_FALSE(ok_);
  EXPECT_EQ(delay_.qdelay(), Duration(0));
  ok_ = true;
  Run(1, -3000ms, 0ms);
  EXPECT_FALSE(ok_);
  EXPECT_EQ(delay_.qdelay(), Duration(0));
}

TEST_F(QueueDelayTest, ARealQueueOfASecondIsAQueue) {
  Run(30, 20ms, 0ms);
  Run(1, 1020ms, 1000ms);
  EXPECT_TRUE(ok_);
  EXPECT_EQ(delay_.qdelay(), Duration(1s));
}

TEST_F(QueueDelayTest, AQueueThatStandsForMinutesIsNoClock) {
  parameters_.clock_drift = false;
  Run(30, 20ms, 0ms);
  Run(1000, 210ms, 190ms);
  // The delay of 190 ms becomes part of the lowest round trip.
  for (int i = 0; i < 100; ++i, now_ += 1s) {
    ok_ = delay_.Add(now_, {now_ - 20ms, now_ + 190ms + 1h, 0ms, 20ms - 1h}) && ok_;
    delay_.Update(now_, 40ms);
    ASSERT_EQ(delay_.qdelay(), Duration(190ms));
  }
  EXPECT_TRUE(ok_);
}

TEST_F(QueueDelayTest, AHandoverThatHoldsReportsAndPacketsIsNoClock) {
  Run(30, 20ms, 0ms);
  ok_ = delay_.Add(now_, {now_ - 20ms, now_ + 1h, 300ms, 320ms - 1h}) && ok_;
  ok_ = delay_.Add(now_, {now_ - 320ms, now_ + 1h, 300ms, 20ms - 1h}) && ok_;
  EXPECT_TRUE(ok_);
  EXPECT_EQ(delay_.qdelay(), Duration(300ms));
}

TEST_F(QueueDelayTest, TheDraftKnowsNoClockJumps) {
  parameters_ = Parameters::Draft();
  Run(30, 20ms, 0ms);
  Run(1, 3020ms, 0ms);
  EXPECT_TRUE(ok_);
  EXPECT_EQ(delay_.qdelay(), Duration(3s));
}

TEST_F(QueueDelayTest, TheAverageFallsUntilItsNextUpdateAtWhichItDoesNot) {
  Run(25, 20ms, 0ms);
  Run(50, 60ms, 40ms);
  EXPECT_FALSE(delay_.qdelay_avg_falls());
  Run(25, 25ms, 5ms);
  EXPECT_TRUE(delay_.qdelay_avg_falls());
  Run(25, 25ms, 5ms);
  EXPECT_FALSE(delay_.qdelay_avg_falls());
}

TEST_F(QueueDelayTest, ResetForgetsAllAverages) {
  Run(30, 20ms, 0ms);
  for (int i = 0; i < 40; ++i) {
    Run(26, 20ms, 0ms);
    Run(26, 50ms, 30ms);
  }
  delay_.Reset();
  EXPECT_EQ(delay_.qdelay_avg(), Duration(0));
  QueueDelay fresh(parameters_);
  EXPECT_EQ(delay_.ref_wnd_delay_scale(), fresh.ref_wnd_delay_scale());
  for (int i = 0; i < 200; ++i, now_ += 1ms) {
    for (QueueDelay* delay : {&delay_, &fresh}) {
      delay->Add(now_, {now_ - 20ms, now_, 0ms, 20ms});
      delay->Update(now_, 40ms);
    }
    ASSERT_EQ(delay_.ref_wnd_delay_scale(), fresh.ref_wnd_delay_scale()) << i;
  }
}

TEST_F(QueueDelayTest, JitterLowersTheScale) {
  Run(30, 20ms, 0ms);
  for (int i = 0; i < 40; ++i) {
    Run(26, 20ms, 0ms);
    Run(26, 50ms, 30ms);
  }
  EXPECT_LT(delay_.ref_wnd_delay_scale(), 0.1);
}

TEST_F(QueueDelayTest, ADriftingClockIsGivenANewBase) {
  int rounds = 0;
  for (; rounds < 1000 && !new_base_; ++rounds) Run(41, 20ms + rounds * 100us, 100ms);
  EXPECT_TRUE(new_base_);
  EXPECT_EQ(delay_.qdelay(), Duration(0));
  new_base_ = false;
  Run(410, 70ms + rounds * 100us, 100ms);
  EXPECT_FALSE(new_base_) << "ten round trips behind a queue are no drift";
}

TEST(RoundTripTime, SmoothsByAnEighth) {
  RoundTripTime rtt;
  EXPECT_FALSE(rtt.known());
  rtt.Add(kStart, 40ms);
  rtt.Add(kStart, 80ms);
  EXPECT_EQ(rtt.smoothed(), Duration(45ms));
  EXPECT_EQ(rtt.min(), Duration(40ms));
  for (int i = 0; i < 61; ++i) rtt.Add(kStart + i * 1s, 80ms);
  EXPECT_EQ(rtt.min(), Duration(80ms));
}

/// Adds packets of 1000 bytes that were sent `sent` apart and arrived `spacing` apart, behind a
/// queue. Returns the time after the last arrival.
Time Arrive(BusyRun* run, Time now, Duration spacing, int packets, Duration sent = 500us) {
  for (int i = 0; i < packets; ++i, now += spacing)
    run->Add({kStart + i * sent, now, DataSize::Bytes(1000), 5ms, true, true});
  return now;
}

TEST(BusyRun, MeasuresTheLinkByTheSpacingOfWhatItHeldBack) {
  BusyRun run;
  Arrive(&run, kStart, 1ms, 8);
  EXPECT_FALSE(run.capacity());  // seven gaps of 1 ms, of which the first does not count
  Arrive(&run, kStart + 8ms, 1ms, 1);
  ASSERT_TRUE(run.capacity());
  EXPECT_NEAR(run.capacity()->bits_per_second(), 8e6, 1);
}

TEST(BusyRun, AMomentInWhichNothingMovedIsNoSlowness) {
  BusyRun run;
  const Time stop = Arrive(&run, kStart, 1ms, 10);
  Arrive(&run, stop + 80ms, 1ms, 10);
  ASSERT_TRUE(run.capacity());
  EXPECT_NEAR(run.capacity()->bits_per_second(), 8e6, 1);
}

TEST(BusyRun, TellsByHowManyPacketsTheQueueGrew) {
  BusyRun run;
  EXPECT_EQ(run.growth(), 0);
  Arrive(&run, kStart, 1ms, 2, 500us);
  EXPECT_EQ(run.growth(), 0) << "the one gap may be a pause";
  run.Reset();
  Arrive(&run, kStart, 1ms, 12, 500us);
  EXPECT_NEAR(run.growth(), 10, 1e-6);
  run.Reset();
  Arrive(&run, kStart, 2ms, 10, 2ms);
  EXPECT_EQ(run.growth(), 0);
  run.Add({kStart + 20ms, kStart + 100ms, DataSize::Bytes(1000), 5ms, true, true});
  EXPECT_EQ(run.growth(), 0) << "the longest pause counts on neither side";
}

TEST(BusyRun, TakesAPauseOfTheSourceForNoGrowth) {
  BusyRun run;
  Arrive(&run, kStart, 1ms, 12, 500us);
  run.Add({kStart + 36ms, kStart + 51ms, DataSize::Bytes(1000), 5ms, true, true});
  EXPECT_NEAR(run.growth(), 11, 1e-6);
}

TEST(BusyRun, APacketThatWasOvertakenMakesNoGapThatIsNegative) {
  BusyRun run;
  Arrive(&run, kStart + 20ms, 1ms, 10, 500us);
  run.Add({kStart - 10ms, kStart + 31ms, DataSize::Bytes(1000), 5ms, true, true});
  EXPECT_LT(run.growth(), 15);
  EXPECT_GT(run.growth(), 5);
}

TEST(BusyRun, GrowsWithoutBoundByPacketsThatLeftAtOnce) {
  BusyRun run;
  Arrive(&run, kStart, 1ms, 10, 0ms);
  EXPECT_GT(run.growth(), 1e6);
}

/// Frames of ten packets, one frame every 20 ms. In each frame, the delay grows from packet to
/// packet.
class LossContextTest : public ::testing::Test {
 protected:
  /// Sends `frames` frames. In frame number f, the packet with the index lost(f) is lost.
  template <class Index>
  void Lose(int frames, Index lost) {
    for (int f = 0; f < frames; ++f, now_ += 20ms) {
      for (int i = 0; i < 10; ++i)
        if (i != lost(f)) context_.OnAcked(now_ + i * 1ms, i * 300us);
      context_.OnLost(now_ + lost(f) * 1ms);
    }
  }
  LossContext context_;
  Time now_ = kStart;
};

TEST_F(LossContextTest, FindsAQueueThatOverflowsHoweverShort) {
  Lose(100, [](int) { return 9; });
  EXPECT_TRUE(context_.AtFullQueue());
}

TEST_F(LossContextTest, KnowsRandomLossFromIt) {
  for (int i = 0; i < 50; ++i) {
    Lose(10, [](int frame) { return frame * 7 % 10; });
    EXPECT_FALSE(context_.AtFullQueue()) << i;
  }
}

/// LossContext compares the longer delay of the two packets around a loss with the longer delay of
/// each other pair. In a comparison with single delays it would mostly be longer, even if losses
/// are random.
TEST_F(LossContextTest, KnowsRandomLossWhereDelaysScatter) {
  link::Random random(1);
  for (int i = 0; i < 5000; ++i, now_ += 1ms) {
    if (i % 10 == 0) continue;
    context_.OnAcked(now_, FromSeconds(0.003 * random.Uniform()));
    if (i % 10 == 5) context_.OnLost(now_ - 5ms);
    ASSERT_FALSE(context_.AtFullQueue()) << i;
  }
}

TEST_F(LossContextTest, ForgetsTheDelaysOfALongerQueue) {
  for (int i = 0; i < 2000; ++i, now_ += 1ms) context_.OnAcked(now_, 50ms);
  Lose(100, [](int) { return 9; });
  EXPECT_TRUE(context_.AtFullQueue());
}

TEST(BusyRun, TellsWhatTheLinkCarriesAfterAHole) {
  BusyRun run;
  Time now = kStart;
  const auto arrive = [&](int packets, Duration spacing) {
    for (int i = 0; i < packets; ++i, now += spacing)
      run.Add({now - 500ms, now, DataSize::Bytes(1000), 500ms, true, false});
  };
  arrive(6, 50ms);
  EXPECT_FALSE(run.latest_capacity());
  arrive(8, 1ms);
  ASSERT_TRUE(run.latest_capacity());
  EXPECT_NEAR(run.latest_capacity()->bits_per_second(), 8e6, 1);
  EXPECT_NEAR(run.capacity()->bits_per_second(), 8e6, 1) << "not that of the hole";
}

TEST(BusyRun, APauseOfTheSourceIsNoHole) {
  BusyRun run;
  EXPECT_FALSE(run.Add({kStart, kStart, DataSize::Bytes(1000), 5ms, true, false}));
  EXPECT_FALSE(run.Add({kStart, kStart + 1s, DataSize::Bytes(1000), 5ms, true, false}));
  EXPECT_TRUE(run.Add({kStart, kStart + 2s, DataSize::Bytes(1000), 500ms, true, false}));
}

TEST(BusyRun, FindsAHoleBehindAPacketThatDidNotWait) {
  BusyRun run;
  EXPECT_FALSE(run.Add({kStart, kStart, DataSize::Bytes(1000), 0ms, false, false}));
  EXPECT_TRUE(run.Add({kStart, kStart + 1s, DataSize::Bytes(1000), 900ms, true, false}));
}

TEST(BusyRun, EndsWhereArrivalsGoBack) {
  BusyRun run;
  Arrive(&run, kStart, 1ms, 20);
  Arrive(&run, kStart, 1ms, 1);
  EXPECT_EQ(run.packets(), 1);
}

TEST(BusyRun, EndsWithAPacketThatDidNotWait) {
  BusyRun run;
  const Time now = Arrive(&run, kStart, 1ms, 20);
  run.Add({kStart, now, DataSize::Bytes(1000), 0ms, false, false});
  EXPECT_FALSE(run.capacity());
  EXPECT_EQ(run.packets(), 0);
}

}  // namespace
}  // namespace lidar::scream
