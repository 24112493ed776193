// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests when the receiver sends a report, and what the report contains.
#include "src/rtcp/feedback_generator.h"

#include <gtest/gtest.h>

#include <set>

#include "src/sim/simulated_time.h"

namespace lidar::rtcp {
namespace {

class FeedbackGeneratorTest : public ::testing::Test {
 protected:
  void Arrive(std::uint16_t seq, bool marker = false, Ecn ecn = Ecn::kEct1,
              std::uint32_t ssrc = 1) {
    generator_.OnPacket(now_, {ssrc, seq, ecn, marker, DataSize::Bytes(1000)});
  }
  /// Receives the first packet and takes the report that is due for it at once.
  void Begin() {
    Arrive(0);
    ASSERT_TRUE(generator_.Take(now_));
  }
  static std::vector<int> Received(const SsrcReport& block) {
    std::vector<int> seqs;
    for (std::size_t i = 0; i < block.metrics.size(); ++i)
      if (block.metrics[i].received)
        seqs.push_back(static_cast<std::uint16_t>(block.begin_seq + i));
    return seqs;
  }

  FeedbackGenerator generator_;
  Time now_ = kStart;
};

TEST_F(FeedbackGeneratorTest, NothingIsDueBeforeThereIsAPacket) {
  EXPECT_EQ(generator_.NextDue(), Time::max());
  EXPECT_FALSE(generator_.Take(now_ + 10s));
}

TEST_F(FeedbackGeneratorTest, AMarkerIsReportedAtOnce) {
  Begin();
  now_ += 1ms;
  Arrive(1);
  EXPECT_FALSE(generator_.Take(now_));
  Arrive(2, true);
  const auto report = generator_.Take(now_);
  ASSERT_TRUE(report);
  EXPECT_EQ(Received(report->blocks[0]), (std::vector<int>{0, 1, 2}));
}

TEST_F(FeedbackGeneratorTest, SixteenPacketsAreReportedAtOnce) {
  Begin();
  for (std::uint16_t seq = 1; seq <= 15; ++seq) Arrive(seq);
  EXPECT_FALSE(generator_.Take(now_));
  Arrive(16);
  EXPECT_TRUE(generator_.Take(now_));
}

TEST_F(FeedbackGeneratorTest, APacketWaitsNoLongerThanTheInterval) {
  Begin();
  now_ += 1ms;
  Arrive(1);
  EXPECT_EQ(generator_.NextDue(), kStart + 40ms);
  EXPECT_FALSE(generator_.Take(kStart + 39ms));
  EXPECT_TRUE(generator_.Take(kStart + 40ms));
  now_ = kStart + 1s;
  Arrive(2);
  EXPECT_EQ(generator_.NextDue(), now_);
}

TEST_F(FeedbackGeneratorTest, TheIntervalShrinksToFiveMillisecondsAtHighRate) {
  for (std::uint16_t seq = 0; seq < 2000; ++seq) {
    Arrive(seq);
    generator_.Take(now_);
    now_ += 200us;  // This is 40 Mbit/s.
  }
  while (generator_.Take(now_)) {
  }
  Arrive(2000);
  const Time first = now_;
  if (generator_.NextDue() <= now_) generator_.Take(now_);
  now_ += 1ms;
  Arrive(2001);
  EXPECT_LE(generator_.NextDue(), first + 6ms);
}

TEST_F(FeedbackGeneratorTest, TheIntervalIsFiveMillisecondsAtLeast) {
  for (std::uint16_t seq = 0; seq < 5000; ++seq) {
    Arrive(seq);
    now_ += 20us;  // This is 400 Mbit/s.
    while (generator_.Take(now_)) {
    }
  }
  const Time last = std::max(generator_.NextDue(), now_);
  now_ = last + 1ms;
  Arrive(5000);
  while (generator_.Take(now_)) {
  }
  const Time reported = now_;
  Arrive(5001);
  EXPECT_EQ(generator_.NextDue(), reported + 5ms);
}

TEST_F(FeedbackGeneratorTest, AChangeToCeAndBackIsReportedNoFasterThanEveryFiveMilliseconds) {
  Begin();
  now_ += 1ms;
  Arrive(1, false, Ecn::kCe);
  EXPECT_EQ(generator_.NextDue(), kStart + 5ms);
  now_ = kStart + 5ms;
  ASSERT_TRUE(generator_.Take(now_));
  now_ += 7ms;
  Arrive(2, false, Ecn::kCe);  // The packet before was marked, too.
  EXPECT_EQ(generator_.NextDue(), kStart + 45ms);
  Arrive(3);
  EXPECT_EQ(generator_.NextDue(), now_);
}

TEST_F(FeedbackGeneratorTest, ReportsOverlapSoThatALostOneCostsNothing) {
  for (std::uint16_t seq = 0; seq < 100; ++seq) Arrive(seq, seq % 10 == 9), generator_.Take(now_);
  Arrive(100, true);
  const auto report = generator_.Take(now_);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->blocks[0].begin_seq, 100 - 32);
  EXPECT_EQ(Received(report->blocks[0]).size(), 33U);
}

TEST_F(FeedbackGeneratorTest, GapsAreReportedAsMissingAndALatePacketFillsThem) {
  Begin();
  Arrive(1);
  Arrive(3, true);
  auto report = generator_.Take(now_);
  EXPECT_EQ(Received(report->blocks[0]), (std::vector<int>{0, 1, 3}));
  EXPECT_EQ(generator_.stats().lost, 1U);
  Arrive(2, true);
  report = generator_.Take(now_);
  ASSERT_TRUE(report);
  EXPECT_EQ(Received(report->blocks[0]), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(generator_.stats().lost, 0U);
  EXPECT_EQ(generator_.stats().reordered, 1U);
}

TEST_F(FeedbackGeneratorTest, PacketsFromBeforeTheFirstOneAreNotLostAndThoseBetweenAre) {
  Arrive(100);
  Arrive(102);
  EXPECT_EQ(generator_.stats().lost, 1U);
  Arrive(97);
  EXPECT_EQ(generator_.stats().lost, 3U) << "98, 99 and 101";
}

TEST_F(FeedbackGeneratorTest, AReportReachesBackToTheOldestOfThoseThatCameLate) {
  for (std::uint16_t seq = 0; seq < 100; ++seq)
    if (seq != 10 && seq != 20) Arrive(seq, seq == 99), generator_.Take(now_);
  Arrive(20);
  Arrive(10, true);
  const auto report = generator_.Take(now_);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->blocks[0].begin_seq, 10);
}

TEST_F(FeedbackGeneratorTest, APacketFromBeforeTheFirstOneIsReportedToo) {
  Arrive(10);
  Arrive(9);
  EXPECT_EQ(Received(generator_.Take(now_)->blocks[0]), (std::vector<int>{9, 10}));
  EXPECT_EQ(generator_.stats().stale, 0U);
}

TEST_F(FeedbackGeneratorTest, CountsWhatItSendsWithAllHeaders) {
  Begin();
  EXPECT_EQ(generator_.stats().sent.bytes(), 28 + 12 + 8 + 4);
}

TEST_F(FeedbackGeneratorTest, OwesNothingForASourceThatItForgot) {
  Begin();
  for (std::uint16_t seq = 1; seq <= 10; ++seq) Arrive(seq);
  now_ += 31s;
  Arrive(7, true, Ecn::kEct1, 2);
  ASSERT_EQ(generator_.Take(now_)->blocks.size(), 1U);
  EXPECT_EQ(generator_.NextDue(), Time::max());
}

TEST_F(FeedbackGeneratorTest, OwesNothingForTheNumbersOfBeforeARestart) {
  Begin();
  for (std::uint16_t seq = 1; seq <= 10; ++seq) Arrive(seq);
  Arrive(20000);
  Arrive(20001, true);
  ASSERT_TRUE(generator_.Take(now_));
  EXPECT_EQ(generator_.NextDue(), Time::max());
}

TEST_F(FeedbackGeneratorTest, OwesNothingForASourceThatItWasToForget) {
  Begin();
  for (std::uint16_t seq = 1; seq <= 10; ++seq) Arrive(seq);
  generator_.Forget(99);  // The source 99 is unknown.
  generator_.Forget(1);
  Arrive(500, true);
  const auto report = generator_.Take(now_);
  ASSERT_TRUE(report);
  ASSERT_EQ(report->blocks.size(), 1U);
  EXPECT_EQ(report->blocks[0].begin_seq, 500);
  EXPECT_EQ(generator_.NextDue(), Time::max());
}

TEST_F(FeedbackGeneratorTest, ReportsSixtyFourSourcesAtMost) {
  std::set<std::uint32_t> reported;
  for (std::uint32_t ssrc = 1; ssrc <= 70; ++ssrc) Arrive(5, true, Ecn::kEct1, ssrc);
  while (const auto report = generator_.Take(now_))
    for (const SsrcReport& block : report->blocks) reported.insert(block.ssrc);
  EXPECT_EQ(reported.size(), 64U);
}

TEST_F(FeedbackGeneratorTest, SequenceNumbersWrapAround) {
  Arrive(65534);
  generator_.Take(now_);
  Arrive(65535);
  Arrive(0);
  Arrive(1, true);
  const auto report = generator_.Take(now_);
  ASSERT_TRUE(report);
  EXPECT_EQ(Received(report->blocks[0]), (std::vector<int>{65534, 65535, 0, 1}));
}

TEST_F(FeedbackGeneratorTest, ADuplicateCountsOnceButItsCeIsKept) {
  Begin();
  Arrive(1);
  Arrive(1, false, Ecn::kCe);
  Arrive(2, true);
  const auto report = generator_.Take(now_);
  EXPECT_EQ(report->blocks[0].metrics[1].ecn, Ecn::kCe);
  EXPECT_EQ(generator_.stats().duplicates, 1U);
}

TEST_F(FeedbackGeneratorTest, OffsetsTellWhenEachPacketArrived) {
  Begin();
  now_ += 3ms;
  Arrive(1);
  now_ += 4ms;
  Arrive(2, true);
  const auto report = generator_.Take(now_ + 1ms);
  EXPECT_EQ(report->blocks[0].metrics[1].arrival_offset, Duration(5ms));
  EXPECT_EQ(report->blocks[0].metrics[2].arrival_offset, Duration(1ms));
}

TEST_F(FeedbackGeneratorTest, AFarJumpIsBelievedOnlyFromASecondPacket) {
  for (std::uint16_t seq = 0; seq < 50; ++seq) Arrive(seq, true), generator_.Take(now_);
  Arrive(30000, true);
  EXPECT_FALSE(generator_.Take(now_));
  EXPECT_EQ(generator_.stats().stale, 1U);
  Arrive(50, true);
  EXPECT_TRUE(generator_.Take(now_));
  Arrive(40000, true);
  Arrive(40001, true);
  const auto report = generator_.Take(now_);
  ASSERT_TRUE(report);
  EXPECT_EQ(Received(report->blocks[0]), (std::vector<int>{40001}));
}

TEST_F(FeedbackGeneratorTest, TwoFarJumpsWithAPacketBetweenThemAreNoRestart) {
  Begin();
  Arrive(20000);
  Arrive(1);
  Arrive(20001, true);
  Arrive(2, true);
  EXPECT_EQ(generator_.stats().stale, 2U);
  EXPECT_EQ(Received(generator_.Take(now_)->blocks[0]), (std::vector<int>{0, 1, 2}));
}

TEST_F(FeedbackGeneratorTest, ReportsNeverOutweighWhatWasReceived) {
  for (int i = 0; i < 2000; ++i) {
    generator_.OnPacket(now_, {static_cast<std::uint32_t>(i % 200), static_cast<std::uint16_t>(i),
                               Ecn::kEct1, true, DataSize::Bytes(50)});
    generator_.Take(now_);
    EXPECT_LE(generator_.stats().sent, generator_.stats().received);
  }
  EXPECT_GT(generator_.stats().reports, 0U);
}

TEST_F(FeedbackGeneratorTest, WhatDoesNotFitGoesIntoTheNextReport) {
  FeedbackConfig config;
  config.max_report = DataSize::Bytes(100);  // room for 40 metrics
  config.packets_per_feedback = 1000;
  config.report_on_marker = false;
  generator_ = FeedbackGenerator(config);
  Begin();
  for (std::uint16_t seq = 1; seq <= 100; ++seq) Arrive(seq);
  std::set<int> reported;
  int reports = 0;
  for (now_ += 40ms; auto report = generator_.Take(now_); ++reports)
    for (const int seq : Received(report->blocks[0])) reported.insert(seq);
  EXPECT_EQ(reports, 3);
  EXPECT_EQ(reported.size(), 100U);
}

TEST_F(FeedbackGeneratorTest, ForgetsTheOldestOfAnEndlessBacklog) {
  for (int i = 0; i < 100; ++i) Arrive(static_cast<std::uint16_t>(2'900 * i));
  const auto report = generator_.Take(now_);
  ASSERT_TRUE(report);
  EXPECT_LE(static_cast<std::uint16_t>(2'900 * 99 - report->blocks[0].begin_seq), 8'192);
}

TEST_F(FeedbackGeneratorTest, SeveralSourcesShareAReport) {
  Begin();
  Arrive(1);
  Arrive(7, true, Ecn::kEct1, 2);
  const auto report = generator_.Take(now_);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->blocks.size(), 2U);
}

}  // namespace
}  // namespace lidar::rtcp
