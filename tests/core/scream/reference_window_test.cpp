// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that the reference window follows the pseudo code of the draft.
#include "src/scream/response/reference_window.h"

#include <gtest/gtest.h>

#include <cmath>

#include "src/sim/simulated_time.h"

namespace lidar::scream {
namespace {

class ReferenceWindowTest : public ::testing::Test {
 protected:
  ReferenceWindowTest() {
    signals_.s_rtt = 25ms;
    signals_.target_bitrate = Mbps(5);
    signals_.target_bitrate_max = Mbps(100);
    signals_.max_bytes_in_flight_prev = DataSize::Bytes(1000000);
    window_.Set(DataSize::Bytes(100000));
  }
  /// Updates the window after the time `after`, and returns the factor by which the window changed.
  /// Unless a test sets `bytes_newly_acked`, the window never grows.
  double Factor(Duration after = 1s) {
    const auto before = static_cast<double>(window_.ref_wnd().bytes());
    now_ += after;
    reason_ = window_.Update(now_, signals_);
    return static_cast<double>(window_.ref_wnd().bytes()) / before;
  }

  Parameters parameters_ = Parameters::Draft();
  CongestionSignals signals_;
  ReferenceWindow window_{parameters_};
  Time now_ = kStart;
  RateReason reason_ = RateReason::kIncrease;
};

TEST_F(ReferenceWindowTest, IsNeverSetBelowItsMinimum) {
  window_.Set(DataSize::Bytes(1));
  EXPECT_EQ(window_.ref_wnd(), parameters_.min_ref_wnd);
}

TEST_F(ReferenceWindowTest, IsLoweredByALimitAndNeverRaised) {
  window_.Limit(DataSize::Bytes(200000));
  EXPECT_EQ(window_.ref_wnd().bytes(), 100000);
  window_.Limit(DataSize::Bytes(50000));
  EXPECT_EQ(window_.ref_wnd().bytes(), 50000);
}

TEST_F(ReferenceWindowTest, GivesATargetOverTheRoundTripWithTheDraftsReserves) {
  window_.Set(DataSize::Bytes(50000));
  EXPECT_NEAR(window_.TargetBitrate(40ms, 0).bits_per_second(), 1e7 * (1000.0 / 1020) / 1.2, 1);
  window_.Set(DataSize::Bytes(3000));
  EXPECT_NEAR(window_.TargetBitrate(40ms, 0.3).bits_per_second(), 6e5 * 0.8 * (1000.0 / 1020) / 1.5,
              1);
}

TEST_F(ReferenceWindowTest, AStartForgetsTheSignsOfTheRouteBefore) {
  signals_.loss_detected = signals_.data_units_marked = true;
  Factor();
  Factor(1ms);  // too soon for another reduction
  signals_.loss_detected = signals_.data_units_marked = false;
  window_.Start(Mbps(5), 25ms);
  EXPECT_EQ(Factor(), 1);
}

TEST_F(ReferenceWindowTest, LossScalesByBetaLoss) {
  signals_.loss_detected = true;
  EXPECT_NEAR(Factor(), 0.7, 1e-4);
  EXPECT_EQ(reason_, RateReason::kLoss);
}

TEST_F(ReferenceWindowTest, ClassicEcnScalesByBetaEcn) {
  signals_.data_units_marked = true;
  signals_.is_l4s = false;
  EXPECT_NEAR(Factor(), 0.8, 1e-4);
}

TEST_F(ReferenceWindowTest, L4sScalesByHalfOfAlpha) {
  signals_.data_units_marked = true;
  signals_.l4s_alpha = 0.4;
  EXPECT_NEAR(Factor(), 0.8, 1e-4);
  EXPECT_EQ(reason_, RateReason::kCe);
}

TEST_F(ReferenceWindowTest, L4sIsGentlerCloseToTheInflectionPointUnlessTheQueueIsLong) {
  signals_.data_units_marked = true;
  signals_.l4s_alpha = 0.1;
  Factor();  // The window is now 5 % below the inflection point.
  EXPECT_NEAR(Factor(), 1 - 0.05 * 0.25, 1e-4);
  signals_.qdelay = 16ms;
  EXPECT_NEAR(Factor(), 1 - 0.05, 1e-4);
}

TEST_F(ReferenceWindowTest, LongRoundTripsReactInPartsEveryVirtualRtt) {
  signals_.data_units_marked = true;
  signals_.l4s_alpha = 0.4;
  signals_.s_rtt = 100ms;
  EXPECT_NEAR(Factor(), 1 - 0.2 / 4, 1e-4);
  EXPECT_DOUBLE_EQ(Factor(24ms), 1);
  EXPECT_EQ(reason_, RateReason::kIncrease);
  EXPECT_LT(Factor(1ms), 1);
}

TEST_F(ReferenceWindowTest, QueueDelayActsAsVirtualMarks) {
  signals_.qdelay = signals_.qdelay_avg = 45ms;
  EXPECT_NEAR(Factor(), 0.75, 1e-4);
  EXPECT_EQ(reason_, RateReason::kDelay);
  signals_.qdelay_avg = 30ms;
  EXPECT_DOUBLE_EQ(Factor(), 1);
}

TEST_F(ReferenceWindowTest, AQueueDelayThatFallsIsNoCongestion) {
  signals_.qdelay = signals_.qdelay_avg = 45ms;
  signals_.qdelay_avg_falls = true;
  EXPECT_DOUBLE_EQ(Factor(), 1);
  signals_.data_units_marked = true;
  Factor();
  EXPECT_EQ(reason_, RateReason::kCe);
}

TEST_F(ReferenceWindowTest, TheInflectionPointWaitsForGrowthByFivePercent) {
  const auto reduce_at = [this](std::int64_t window, Duration after) {
    window_.Set(DataSize::Bytes(window));
    Factor(after);
    return window_.ref_wnd_i().bytes();
  };
  signals_.loss_detected = true;
  EXPECT_EQ(reduce_at(100000, 25ms), 100000);  // The window falls to 70000.
  EXPECT_EQ(reduce_at(73500, 25ms), 100000);   // The window falls to 51450.
  EXPECT_EQ(reduce_at(54023, 25ms), 54023);
}

TEST_F(ReferenceWindowTest, TheInflectionPointWaitsFiftyRoundTripsAtMost) {
  signals_.loss_detected = true;
  Factor();
  Factor(50 * 25ms);
  EXPECT_EQ(window_.ref_wnd_i().bytes(), 100000);
  Factor(25ms);
  EXPECT_EQ(window_.ref_wnd_i().bytes(), 49000);
}

TEST_F(ReferenceWindowTest, AfterALongTimeWithoutCongestionItComesBackToWhatIsInFlight) {
  signals_.data_units_marked = true;
  signals_.max_bytes_in_flight_prev = DataSize::Bytes(40000);
  EXPECT_NEAR(Factor(10s), 0.4, 1e-4);
}

TEST_F(ReferenceWindowTest, NeverFallsBelowItsMinimum) {
  signals_.loss_detected = true;
  for (int i = 0; i < 50; ++i) Factor();
  EXPECT_EQ(window_.ref_wnd().bytes(), 3000);
}

TEST_F(ReferenceWindowTest, GrowsByOneMssARoundTripRightAfterCongestion) {
  signals_.data_units_marked = true;
  signals_.l4s_alpha = 1;
  Factor();
  const auto before = window_.ref_wnd().bytes();
  signals_ = {};
  signals_.s_rtt = 25ms;
  signals_.target_bitrate_max = Mbps(100);
  signals_.max_bytes_in_flight = DataSize::Bytes(100000);
  signals_.bytes_newly_acked = window_.ref_wnd();
  window_.Update(now_, signals_);
  EXPECT_NEAR(static_cast<double>(window_.ref_wnd().bytes() - before), 1000, 2);
}

TEST_F(ReferenceWindowTest, GrowsByTwoPercentMoreLongAfterCongestion) {
  signals_.max_bytes_in_flight = DataSize::Bytes(100000);
  signals_.bytes_newly_acked = DataSize::Bytes(100000);
  EXPECT_NEAR(Factor(), 1.03, 1e-4);  // MSS / window, and MUL_INCREASE_FACTOR
}

TEST_F(ReferenceWindowTest, DoesNotGrowFarAboveWhatIsInFlightNorAtTheMaximumBitrate) {
  signals_.bytes_newly_acked = DataSize::Bytes(100000);
  signals_.max_bytes_in_flight_prev = DataSize::Bytes(60000);
  EXPECT_DOUBLE_EQ(Factor(), 1);
  signals_.max_bytes_in_flight = DataSize::Bytes(100000);
  signals_.target_bitrate = signals_.target_bitrate_max;
  EXPECT_DOUBLE_EQ(Factor(), 1);
}

TEST_F(ReferenceWindowTest, MarkedBytesDoNotMakeItGrow) {
  signals_.max_bytes_in_flight = DataSize::Bytes(100000);
  signals_.bytes_newly_acked = signals_.bytes_newly_acked_ce = DataSize::Bytes(50000);
  EXPECT_DOUBLE_EQ(Factor(), 1);
}

TEST_F(ReferenceWindowTest, ALossThatIsNoCongestionIsForgotten) {
  signals_.loss_detected = true;
  signals_.loss_is_congestion = false;
  EXPECT_DOUBLE_EQ(Factor(), 1);
  signals_.loss_detected = false;
  signals_.loss_is_congestion = true;
  EXPECT_DOUBLE_EQ(Factor(), 1);
}

TEST_F(ReferenceWindowTest, ReactsLessWhereTheTargetHasFallenAlready) {
  parameters_.undershoot_remedy = true;
  signals_.data_units_marked = true;
  signals_.l4s_alpha = 0.4;
  signals_.acked_bitrate = Mbps(7);
  EXPECT_NEAR(Factor(), 1 - 0.2 / 4, 1e-4);
}

}  // namespace
}  // namespace lidar::scream
