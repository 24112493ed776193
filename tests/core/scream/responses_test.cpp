// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests each response that is not in the draft by itself: outage, send window, pacing.
#include <gtest/gtest.h>

#include <utility>

#include "src/scream/model/evidence.h"
#include "src/scream/response/adaptive_pacing.h"
#include "src/scream/response/fast_increase.h"
#include "src/scream/response/gap_recovery.h"
#include "src/scream/response/isolated_loss.h"
#include "src/scream/response/outage.h"
#include "src/scream/response/send_window.h"
#include "src/sim/simulated_time.h"
#include "tests/core/scream/measured_path.h"

namespace lidar::scream {
namespace {

class OutageTest : public ::testing::Test {
 protected:
  std::optional<DataSize> Timer(Time now, int window) {
    return outage_.OnTimer(now, DataSize::Bytes(window), kRtt, 20ms);
  }
  Parameters parameters_;
  Outage outage_{parameters_};
};

TEST_F(OutageTest, HalvesTheWindowAgainAndAgainAndRestartsFromHalfOfWhatItWas) {
  outage_.OnFeedback(kStart);
  EXPECT_FALSE(Timer(kStart + 280ms, 10000));  // 2 RTT + 200 ms
  EXPECT_EQ(Timer(kStart + 281ms, 10000), DataSize::Bytes(5000));
  EXPECT_FALSE(Timer(kStart + 500ms, 5000));
  EXPECT_EQ(Timer(kStart + 562ms, 5000), DataSize::Bytes(2500));
  EXPECT_EQ(outage_.Silence(kStart + 1s), Duration(1s));
  EXPECT_EQ(outage_.OnFeedback(kStart + 1s), DataSize::Bytes(5000));
  EXPECT_FALSE(outage_.active());
  EXPECT_EQ(outage_.Silence(kStart + 2s), Duration(0));
}

TEST_F(OutageTest, FeedbackWithoutAnOutageRestartsNothing) {
  EXPECT_FALSE(outage_.OnFeedback(kStart));
}

TEST_F(OutageTest, APauseOfTheSourceIsNoSilenceOfTheReceiver) {
  outage_.OnFeedback(kStart);
  outage_.Restart(kStart + 10s);
  EXPECT_FALSE(Timer(kStart + 10100ms, 10000));
}

TEST_F(OutageTest, AReceiverThatReportsSeldomIsWaitedForTwiceAsLong) {
  parameters_.feedback_interval = 400ms;
  outage_.OnFeedback(kStart);
  EXPECT_FALSE(Timer(kStart + 880ms, 10000));  // 2 RTT + 800 ms
  EXPECT_TRUE(Timer(kStart + 881ms, 10000));
}

class GapRecoveryTest : public ::testing::Test {
 protected:
  static constexpr DataSize kWindow = DataSize::Bytes(50000);  // the window for 8 Mbit/s
  std::optional<GapRecovery::Restart> Update(DataSize window) {
    return gaps_.Update(path_.now, path_.model, window);
  }
  /// Delivers packets at 8 Mbit/s, and then only one packet every 100 ms for a second.
  void FallIntoAGap() {
    path_.Arrive(20, 1ms, 1ms, Ecn::kEct1);
    EXPECT_FALSE(Update(kWindow));
    for (int i = 1; i <= 10; ++i) {
      path_.Arrive(1, 100ms, i * 95ms, Ecn::kCe);
      EXPECT_FALSE(Update(DataSize::Bytes(3000))) << i;
    }
    EXPECT_TRUE(gaps_.in_gap());
  }
  Parameters parameters_;
  Path path_{parameters_};
  GapRecovery gaps_{parameters_};
};

TEST_F(GapRecoveryTest, GivesBackTheWindowWhenTheBacklogLeavesAtTheOldRate) {
  FallIntoAGap();
  path_.Arrive(8, 1ms, 900ms, Ecn::kCe);
  const auto restart = Update(DataSize::Bytes(3000));
  ASSERT_TRUE(restart);
  EXPECT_NEAR(restart->window / kWindow, 0.96, 0.02);  // what 8 Mbit/s carry in 1.2 round trips
  EXPECT_LT(Milliseconds(restart->s_rtt), 45);
  EXPECT_FALSE(gaps_.in_gap());
}

TEST_F(GapRecoveryTest, GivesNoMoreThanWhatTheBacklogShows) {
  FallIntoAGap();
  path_.Arrive(8, 3ms, 900ms, Ecn::kCe);
  const auto restart = Update(DataSize::Bytes(3000));
  ASSERT_TRUE(restart);
  EXPECT_NEAR(restart->window / kWindow, 0.32, 0.02);
}

TEST_F(GapRecoveryTest, ComesBackByHalvesWhereThereIsNoBacklogToMeasureBy) {
  FallIntoAGap();
  path_.Arrive(2, 50ms, 0ms, Ecn::kEct1);
  auto restart = Update(DataSize::Bytes(3000));
  ASSERT_TRUE(restart);
  EXPECT_EQ(restart->window.bytes(), 26500);
  EXPECT_FALSE(Update(restart->window)) << "once a round trip";
  path_.Arrive(1, 50ms, 0ms, Ecn::kEct1);
  restart = Update(restart->window);
  ASSERT_TRUE(restart);
  EXPECT_EQ(restart->window.bytes(), 38250);
}

TEST_F(GapRecoveryTest, ComesBackWithTheFirstPacketThatIsNotMarked) {
  FallIntoAGap();
  path_.Arrive(1, 50ms, 0ms, Ecn::kCe);  // This packet was in the gap.
  EXPECT_FALSE(Update(DataSize::Bytes(3000)));
  path_.Arrive(1, 5ms, 4ms, Ecn::kEct1);
  EXPECT_TRUE(Update(DataSize::Bytes(3000)));
}

TEST_F(GapRecoveryTest, BelievesLessOnceAStepBackMeetsASlowLink) {
  FallIntoAGap();
  path_.Arrive(2, 50ms, 0ms, Ecn::kEct1);
  ASSERT_TRUE(Update(DataSize::Bytes(3000)));  // The window becomes 26500.
  const DataRate before = gaps_.rate_before().value();
  path_.Arrive(8, 10ms, 100ms, Ecn::kCe);
  EXPECT_FALSE(Update(DataSize::Bytes(3000)));
  EXPECT_NEAR(*gaps_.rate_before() / before, 26'500 / (kWindow / DataSize::Bytes(1)), 0.001);
  path_.Arrive(2, 100ms, 0ms, Ecn::kEct1);
  const auto restart = Update(DataSize::Bytes(3000));
  ASSERT_TRUE(restart);
  EXPECT_EQ(restart->window.bytes(), 14750);
}

TEST_F(GapRecoveryTest, BelievesAsMuchAsBeforeOnceTheLinkWasMeasured) {
  FallIntoAGap();
  path_.Arrive(2, 50ms, 0ms, Ecn::kEct1);
  // The window becomes 26500, although the link was not measured.
  ASSERT_TRUE(Update(DataSize::Bytes(3000)));
  path_.Arrive(8, 1ms, 900ms, Ecn::kCe);
  ASSERT_TRUE(Update(DataSize::Bytes(3000)));
  path_.Arrive(2, 50ms, 0ms, Ecn::kEct1);
  path_.Arrive(8, 20ms, 100ms, Ecn::kCe);  // begins the next gap
  EXPECT_FALSE(Update(DataSize::Bytes(3000)));
  path_.Arrive(2, 100ms, 0ms, Ecn::kEct1);
  const auto restart = Update(DataSize::Bytes(3000));
  ASSERT_TRUE(restart);
  EXPECT_EQ(restart->window.bytes(), 26500);
}

TEST_F(GapRecoveryTest, BelievesAsMuchAsBeforeOnceTheWindowWasBack) {
  FallIntoAGap();
  DataSize window = DataSize::Bytes(3000);
  // The window grows in steps, because there is no queue.
  for (int i = 0; i < 20 && gaps_.in_gap(); ++i) {
    path_.Arrive(1, 50ms, 0ms, Ecn::kEct1);
    if (const auto restart = Update(window)) window = restart->window;
  }
  path_.Arrive(20, 1ms, 0ms, Ecn::kEct1);
  EXPECT_FALSE(Update(kWindow));
  const DataRate before = gaps_.rate_before().value();
  path_.Arrive(8, 20ms, 100ms, Ecn::kCe);  // begins the next gap
  EXPECT_FALSE(Update(DataSize::Bytes(3000)));
  EXPECT_TRUE(gaps_.in_gap());
  EXPECT_EQ(gaps_.rate_before()->bits_per_second(), before.bits_per_second());
}

TEST_F(GapRecoveryTest, ForgetsAGapOfWhichNothingWasSeenForThreeSeconds) {
  FallIntoAGap();
  path_.now += 3s;
  path_.Arrive(2, 50ms, 0ms, Ecn::kEct1);
  EXPECT_FALSE(Update(DataSize::Bytes(3000)));
  EXPECT_FALSE(gaps_.in_gap());
}

TEST_F(GapRecoveryTest, TakesWhatLastsForMoreThanTenSecondsForWhatTheLinkIs) {
  FallIntoAGap();
  for (int i = 0; i < 20; ++i) {
    path_.Arrive(1, 500ms, 900ms, Ecn::kCe);
    EXPECT_FALSE(Update(DataSize::Bytes(3000)));
  }
  path_.Arrive(8, 1ms, 900ms, Ecn::kCe);
  EXPECT_FALSE(Update(DataSize::Bytes(3000)));
  EXPECT_FALSE(gaps_.in_gap());
}

/// The growth depends on the frame period, on the number of rounds without congestion, on the
/// queue, and on whether the link marks.
TEST(FastIncrease, GrowsByTheRoundsAndLessBehindAQueue) {
  const Parameters p;
  Path unmarked(p);
  Path marked(p);
  marked.Arrive(1, 1ms, 3ms, Ecn::kCe);
  marked.Arrive(200, 1ms, 0ms, Ecn::kEct1);
  Path queued(p);
  queued.Arrive(200, 1ms, p.busy_qdelay / 2, Ecn::kEct1);
  const double max = p.fast_increase_max;
  FastIncrease increase(p);
  const auto growth = [&](const Path& path, Duration period) {
    return increase.growth(path.now, path.model, period) / max;
  };
  EXPECT_DOUBLE_EQ(growth(unmarked, p.long_frame_period / 2), 1);
  EXPECT_DOUBLE_EQ(growth(unmarked, p.long_frame_period), 1);
  EXPECT_NEAR(growth(unmarked, p.long_frame_period * 5 / 4), 0.8, 1e-6);
  EXPECT_DOUBLE_EQ(growth(unmarked, p.long_frame_period * 4), 0.5);
  EXPECT_NEAR(growth(queued, 1ms), 0.5, 0.05);
  increase.OnCongestion(kStart);
  EXPECT_EQ(growth(unmarked, 1ms), 0);
  for (int round = 1; round <= p.fast_increase_rounds + 3; ++round) {
    increase.Update(kStart + round * kRtt, kRtt);
    increase.Update(kStart + round * kRtt + 1ms, kRtt);  // This is still the same round.
    const int bold = std::max(0, round - p.fast_increase_rounds);
    EXPECT_DOUBLE_EQ(growth(unmarked, 1ms) * max,
                     std::min(max, bold * p.fast_increase_step_unmarked));
    EXPECT_DOUBLE_EQ(growth(marked, 1ms) * max, std::min(max, bold * p.fast_increase_step));
  }
  increase.Restart();
  EXPECT_DOUBLE_EQ(growth(unmarked, 1ms), 1);
  EXPECT_EQ(FastIncrease(Parameters::Draft()).growth(unmarked.now, unmarked.model, 1ms), 0);
}

class SendWindowTest : public ::testing::Test {
 protected:
  double Overhead() {
    const DataSize window = DataSize::Bytes(100000);
    return window_.Max(path_.now, window, path_.model) / window;
  }
  Parameters parameters_;
  Path path_{parameters_};
  SendWindow window_{parameters_};
};

TEST_F(SendWindowTest, IsTheDraftsWhereNothingMarks) { EXPECT_NEAR(Overhead(), 3, 0.15); }

TEST_F(SendWindowTest, IsNarrowWhereMarksWork) {
  path_.Arrive(1, 1ms, 3ms, Ecn::kCe);
  path_.Arrive(5, 1ms, 0ms, Ecn::kEct1);
  EXPECT_NEAR(Overhead(), 1.2, 0.01);
}

TEST_F(SendWindowTest, IsClosedToTheWindowBehindAQueue) {
  path_.Arrive(5, 1ms, 20ms, Ecn::kCe);
  EXPECT_NEAR(Overhead(), 1, 0.01);
}

TEST_F(SendWindowTest, IsTwoSegmentsAtLeast) {
  EXPECT_EQ(window_.Max(path_.now, DataSize::Bytes(100), path_.model), 2 * parameters_.mss);
}

TEST_F(SendWindowTest, LetsAPacketGoAtTheMinimumRateWhileItIsClosed) {
  window_.OnSent(kStart);
  const DataSize max = DataSize::Bytes(5000);
  EXPECT_EQ(window_.Opens(kPacket, DataSize::Bytes(4000), max), Time{});
  EXPECT_EQ(window_.Opens(kPacket, DataSize::Bytes(4001), max), kStart + 160ms);
  EXPECT_EQ(window_.Opens(DataSize::Bytes(9000), DataSize(), max), Time{});
}

TEST(PacingHeadroom, LeavesTheReserveAtTheEndOfAFramePeriodWithinLimits) {
  const Parameters p;
  EXPECT_NEAR(PacingHeadroom(p, 16ms, 4ms), 1 / (1 - 0.25), 1e-9);
  EXPECT_NEAR(PacingHeadroom(p, 16ms, 1ms), 1 / (1 - 0.0625), 1e-9);
  EXPECT_NEAR(PacingHeadroom(p, 100ms, 1ms), 1 / (1 - 0.18), 1e-9);
  EXPECT_NEAR(PacingHeadroom(p, 5ms, 4ms), 1 / (1 - 0.35), 1e-9);
  EXPECT_NEAR(PacingHeadroom(Parameters::Draft(), 16ms, 4ms), 1.5, 1e-9);
}

TEST(PacingReserve, IsWhatGoesUnmarkedWithinLimits) {
  const Parameters p;
  Path path(p);
  EXPECT_EQ(PacingReserve(p, path.model, path.now), p.pacing_reserve);
  path.Arrive(200, 1ms, 0ms, Ecn::kCe);
  EXPECT_EQ(PacingReserve(p, path.model, path.now), p.shortest_pacing_reserve);
  path.Arrive(5000, 1ms, 2ms, Ecn::kCe);
  EXPECT_NEAR(Milliseconds(PacingReserve(p, path.model, path.now)), 1.6, 0.1);
}

class LossIsCongestionTest : public ::testing::Test {
 protected:
  /// Reports lost packets until the averaged loss rate of the draft is at least `rate`.
  void LoseUpTo(double rate) {
    while (path_.model.loss_rate() < rate) {
      AckSummary acks;
      acks.lost.emplace_back();
      path_.model.OnReport(path_.now, acks, {DataSize::Bytes(10000), 20ms});
    }
  }
  bool IsCongestion(const Parameters& p) const { return LossIsCongestion(p, path_.model); }
  Parameters draft_ = Parameters::Draft();
  Parameters parameters_;
  Path path_{parameters_};
};

TEST_F(LossIsCongestionTest, IsAnyLossWithoutTheDraftsOptionalPart) {
  EXPECT_TRUE(IsCongestion(draft_));
}

TEST_F(LossIsCongestionTest, IsTheDraftsFromItsRateOrAQuarterOfTheTargetOn) {
  draft_.link_layer_loss = true;
  LoseUpTo(0.005);
  EXPECT_FALSE(IsCongestion(draft_));
  LoseUpTo(0.01);
  EXPECT_TRUE(IsCongestion(draft_));
  path_.Arrive(200, 1ms, 0ms, Ecn::kEct1);
  EXPECT_FALSE(IsCongestion(draft_));
  path_.Arrive(200, 1ms, 25ms, Ecn::kEct1);
  EXPECT_TRUE(IsCongestion(draft_));
}

TEST_F(LossIsCongestionTest, IsFiveTimesTheDraftsRateOnceEcnIsSeenToWork) {
  LoseUpTo(0.04);
  EXPECT_FALSE(IsCongestion(parameters_));
  path_.model.Reset(path_.now);
  LoseUpTo(0.01);
  EXPECT_TRUE(IsCongestion(parameters_)) << "another route";
}

TEST_F(LossIsCongestionTest, IsAnyLossBehindAQueue) {
  path_.Arrive(30, 1ms, 0ms, Ecn::kEct1);
  EXPECT_FALSE(IsCongestion(parameters_));
  path_.Arrive(1, 1ms, 7ms, Ecn::kEct1);
  EXPECT_TRUE(IsCongestion(parameters_));
}

TEST(Evidence, IsOfPacketsSentSinceTheReaction) {
  Evidence evidence;
  EXPECT_TRUE(evidence.LossCounts(kStart) && evidence.MarkCounts(kStart));
  evidence.OnLossReaction(kStart + 1ms);
  EXPECT_FALSE(evidence.LossCounts(kStart));
  EXPECT_TRUE(evidence.MarkCounts(kStart));
  evidence.OnDropReaction(kStart + 1ms);
  EXPECT_FALSE(evidence.MarkCounts(kStart));
  EXPECT_TRUE(evidence.MarkCounts(kStart + 1ms));
  EXPECT_TRUE(evidence.Counts(kStart)) << "its delay is that of the link still";
}

TEST(Evidence, BeginsAnewBehindAnOutageAndNoSoonerForAGapInIt) {
  Evidence evidence;
  evidence.BeginAt(kStart + kRtt);
  evidence.BeginAt(kStart + 10ms);
  for (const Duration at : {20ms, 40ms}) {
    const bool counts = at == kRtt;
    EXPECT_EQ(evidence.Counts(kStart + at), counts);
    EXPECT_EQ(evidence.MarkCounts(kStart + at), counts);
    EXPECT_EQ(evidence.LossCounts(kStart + at), counts);
  }
}

TEST(PathModel, SaysWhetherTheLastReportHasAMarkOrALossThatNoReactionAnswered) {
  const Parameters p;
  Path path(p);
  const auto report = [&path](Time sent, bool late_ce) {
    AckSummary acks;
    acks.lost.emplace_back();
    acks.acked.emplace_back();
    acks.lost.back().sent = acks.acked.back().sent = sent;
    acks.acked.back().arrived_ecn = late_ce ? Ecn::kEct1 : Ecn::kCe;
    if (late_ce) acks.late_ce = {sent};
    path.model.OnReport(path.now, acks, {DataSize::Bytes(10000), 20ms});
    return std::pair(path.model.new_mark(), path.model.new_loss());
  };
  path.model.evidence().OnLossReaction(kStart + 1ms);
  EXPECT_EQ(report(kStart, false), std::pair(true, false));
  path.model.evidence().OnDropReaction(kStart + 1ms);
  for (const bool late_ce : {false, true}) {
    EXPECT_EQ(report(kStart, late_ce), std::pair(false, false)) << late_ce;
    EXPECT_EQ(report(kStart + 1ms, late_ce), std::pair(true, true)) << late_ce;
  }
  path.model.OnReport(path.now, AckSummary(), {DataSize::Bytes(10000), 20ms});
  EXPECT_FALSE(path.model.new_mark() || path.model.new_loss());
}

}  // namespace
}  // namespace lidar::scream
