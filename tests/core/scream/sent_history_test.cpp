// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests which reports the sender accepts, and what it learns from them.
#include "src/scream/model/sent_history.h"

#include <gtest/gtest.h>

#include "src/rtcp/report_clock.h"
#include "src/sim/simulated_time.h"

namespace lidar::scream {
namespace {

using namespace std::chrono_literals;
constexpr Duration kRoundTrip = 40ms;

class SentHistoryTest : public ::testing::Test {
 protected:
  /// Sends the packets from `from` to `until` - 1, one per millisecond.
  void Send(int from, int until) {
    for (int seq = from; seq < until; ++seq, now_ += 1ms)
      history_.OnSent(1, static_cast<std::uint16_t>(seq),
                      {0, DataSize::Bytes(1000), now_, Ecn::kEct1});
  }
  rtcp::CongestionFeedback Report(int begin, const std::string& metrics,
                                  std::uint32_t ssrc = 1) const {
    rtcp::CongestionFeedback f;
    f.report_timestamp = rtcp::ReportClock::ToTimestamp(now_);
    f.blocks.push_back({ssrc, static_cast<std::uint16_t>(begin), {}});
    for (const char c : metrics)
      f.blocks[0].metrics.push_back({c != '-', c == 'C' ? Ecn::kCe : Ecn::kEct1, 0ms});
    return f;
  }
  FeedbackResult Apply(const rtcp::CongestionFeedback& f) {
    summary_ = {};
    return history_.OnFeedback(now_, f, &summary_);
  }
  std::size_t LostWithin(Duration next) {
    now_ += next;
    Apply(Report(0, "r"));
    return summary_.lost.size();
  }

  SentHistory history_;
  AckSummary summary_;
  Time now_ = kStart;
};

TEST_F(SentHistoryTest, BytesInFlightRunFromTheHighestAcknowledgedToTheLastSent) {
  Send(0, 10);
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 10000);
  EXPECT_EQ(Apply(Report(0, "r-r")), FeedbackResult::kAccepted);
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 7000);
  EXPECT_EQ(summary_.bytes_newly_acked.bytes(), 3000);
  EXPECT_EQ(summary_.acked.size(), 2U);
}

TEST_F(SentHistoryTest, KnowsWhatHasBeenInFlightForLongest) {
  EXPECT_FALSE(history_.oldest_in_flight());
  Send(0, 10);
  EXPECT_EQ(history_.oldest_in_flight(), kStart);
  Apply(Report(0, "rr-r"));
  EXPECT_EQ(history_.oldest_in_flight(), kStart + 4ms);
}

/// The packets of stream 2 are older than those of stream 1, but come after them in the report.
TEST_F(SentHistoryTest, TheRoundTripIsOfThePacketSentLast) {
  for (const std::uint32_t ssrc : {2U, 1U}) {
    for (std::uint16_t seq = 0; seq < 2; ++seq, now_ += 5ms)
      history_.OnSent(ssrc, seq, {0, DataSize::Bytes(1000), now_, Ecn::kEct1});
  }
  rtcp::CongestionFeedback f = Report(0, "rr", 1);
  f.blocks.push_back(Report(0, "rr", 2).blocks[0]);
  ASSERT_EQ(Apply(f), FeedbackResult::kAccepted);
  EXPECT_EQ(summary_.rtt, 5ms);
}

/// The report lists all packets of stream 1 first, and then those of stream 2. The summary must
/// have them in the order in which they were sent.
TEST_F(SentHistoryTest, PacketsOfSeveralStreamsComeAsTheyWereSent) {
  for (std::uint16_t seq = 0; seq < 3; ++seq)
    for (std::uint32_t ssrc = 1; ssrc <= 2; ++ssrc, now_ += 1ms)
      history_.OnSent(ssrc, seq, {0, DataSize::Bytes(1000), now_, Ecn::kEct1});
  rtcp::CongestionFeedback f = Report(0, "rrr", 1);
  f.blocks.push_back(Report(0, "rrr", 2).blocks[0]);
  ASSERT_EQ(Apply(f), FeedbackResult::kAccepted);
  ASSERT_EQ(summary_.acked.size(), 6U);
  for (int i = 0; i < 6; ++i)
    EXPECT_EQ(summary_.acked[static_cast<std::size_t>(i)].sent, kStart + i * 1ms);
}

TEST_F(SentHistoryTest, APacketCountsOnceHoweverOftenItIsReported) {
  Send(0, 4);
  Apply(Report(0, "rC"));
  EXPECT_EQ(summary_.bytes_newly_acked_ce.bytes(), 1000);
  EXPECT_EQ(Apply(Report(0, "rC")), FeedbackResult::kStale);
  EXPECT_EQ(Apply(Report(0, "rCr")), FeedbackResult::kAccepted);
  EXPECT_EQ(summary_.acked.size(), 1U);
}

TEST_F(SentHistoryTest, CeOfALaterReportIsNotLost) {
  Send(0, 2);
  Apply(Report(0, "r"));
  EXPECT_EQ(Apply(Report(0, "C")), FeedbackResult::kAccepted);
  EXPECT_EQ(summary_.late_ce.size(), 1U);
  EXPECT_EQ(Apply(Report(0, "C")), FeedbackResult::kStale);
}

TEST_F(SentHistoryTest, RoundTripsLeaveOutTheReceiversHoldingTime) {
  Send(0, 1);
  now_ = kStart + 50ms;
  rtcp::CongestionFeedback f = Report(0, "r");
  f.blocks[0].metrics[0].arrival_offset = 20ms;
  Apply(f);
  ASSERT_TRUE(summary_.rtt);
  EXPECT_EQ(*summary_.rtt, Duration(30ms));
}

TEST_F(SentHistoryTest, AMissingPacketIsLostAtOnceWhileNothingWasReordered) {
  Send(0, 5);
  Apply(Report(0, "r-r"));
  ASSERT_EQ(summary_.lost.size(), 1U);
  EXPECT_EQ(summary_.lost[0].sent, kStart + 1ms);
  EXPECT_EQ(Apply(Report(0, "r-r")), FeedbackResult::kStale);
}

TEST_F(SentHistoryTest, TheReorderingWindowGrowsWithWhatCameLate) {
  Send(0, 20);
  Apply(Report(0, "r-r"));
  now_ += 7ms;
  Apply(Report(0, "rrr"));
  ASSERT_EQ(summary_.acked.size(), 1U);
  EXPECT_TRUE(summary_.acked[0].was_lost);
  Apply(Report(3, "-r"));
  EXPECT_TRUE(summary_.lost.empty());
  EXPECT_EQ(LostWithin(6999us), 0U);
  EXPECT_EQ(LostWithin(1us), 1U);
}

TEST_F(SentHistoryTest, AReportOfAPacketNeverSentIsIgnoredWhole) {
  Send(0, 5);
  EXPECT_EQ(Apply(Report(0, "rrrrrr")), FeedbackResult::kImplausible);
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 5000);
  history_.OnSent(1, 8,
                  {0, DataSize::Bytes(1000), now_, Ecn::kEct1});  // 5 to 7 were dropped unsent
  EXPECT_EQ(Apply(Report(4, "r-r-r")), FeedbackResult::kImplausible);
  EXPECT_EQ(Apply(Report(4, "r---r")), FeedbackResult::kAccepted);
  EXPECT_TRUE(summary_.lost.empty());
}

TEST_F(SentHistoryTest, AnArrivalBeforeTheSendingIsIgnoredWhole) {
  Send(0, 2);
  now_ = kStart + kRoundTrip;
  rtcp::CongestionFeedback f = Report(0, "rr");
  f.blocks[0].metrics[1].arrival_offset = 60ms;
  EXPECT_EQ(Apply(f), FeedbackResult::kImplausible);
}

TEST_F(SentHistoryTest, ForeignSourcesAreCountedAndOursStillTaken) {
  Send(0, 2);
  EXPECT_EQ(Apply(Report(0, "r", 99)), FeedbackResult::kNotOurs);
  rtcp::CongestionFeedback f = Report(0, "r", 99);
  f.blocks.push_back(Report(0, "r").blocks[0]);
  EXPECT_EQ(Apply(f), FeedbackResult::kAccepted);
  EXPECT_EQ(history_.foreign_blocks(), 2U);
}

TEST_F(SentHistoryTest, PacketsFromBeforeThisSenderAreNobodysLie) {
  Send(1000, 1002);
  EXPECT_EQ(Apply(Report(990, "rrrrrrrrrrr")), FeedbackResult::kAccepted);
  EXPECT_EQ(summary_.acked.size(), 1U);
}

TEST_F(SentHistoryTest, SequenceNumbersWrapAround) {
  Send(65530, 65540);
  EXPECT_EQ(Apply(Report(65530, "rrrrrrrr")), FeedbackResult::kAccepted);
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 2000);
}

TEST_F(SentHistoryTest, ExpiredPacketsAreNeitherInFlightNorLost) {
  Send(0, 10);
  history_.Expire(now_);
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 0);
  Send(10, 12);
  EXPECT_EQ(Apply(Report(0, "----------r")), FeedbackResult::kAccepted);
  EXPECT_TRUE(summary_.lost.empty());
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 1000);
}

TEST_F(SentHistoryTest, OnlyTheLastSourcesAreRemembered) {
  for (std::uint32_t ssrc = 100; ssrc < 200; ++ssrc, now_ += 1ms)
    history_.OnSent(ssrc, 7, {0, DataSize::Bytes(1000), now_, Ecn::kEct1});
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 64 * 1000);
  EXPECT_EQ(Apply(Report(7, "r", 100)), FeedbackResult::kNotOurs);
  EXPECT_EQ(Apply(Report(7, "r", 199)), FeedbackResult::kAccepted);
}

TEST_F(SentHistoryTest, NumbersThatGoBackAreThoseOfASenderThatStartedAgain) {
  Send(40480, 40500);
  Send(10000, 10010);
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 9000) << "the second one tells";
  EXPECT_EQ(Apply(Report(40480, "rrrr")), FeedbackResult::kStale) << "of before";
  EXPECT_EQ(Apply(Report(10001, "rrrr")), FeedbackResult::kAccepted);
  EXPECT_EQ(summary_.acked.size(), 4U);
  EXPECT_TRUE(summary_.lost.empty());
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 5000);
}

TEST_F(SentHistoryTest, IsNotFullAfterARestartAtAHighNumber) {
  Send(60000, 60020);
  Send(50000, 50010);
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 9000);
  EXPECT_FALSE(history_.full());
}

TEST_F(SentHistoryTest, ReportsOfBeforeARestartAreForgivenForTwoSeconds) {
  Send(40480, 40500);
  Send(10000, 10010);
  now_ += 1900ms;
  EXPECT_EQ(Apply(Report(40480, "rrrr")), FeedbackResult::kStale);
  now_ += 100ms;
  EXPECT_EQ(Apply(Report(40480, "rrrr")), FeedbackResult::kImplausible);
}

TEST_F(SentHistoryTest, TheReorderingWindowIsNoLongerThanSet) {
  history_.set_max_reordering_window(10ms);
  Send(0, 20);
  Apply(Report(0, "r-r"));
  now_ += 50ms;
  Apply(Report(0, "rrr"));
  Apply(Report(3, "-r"));
  EXPECT_EQ(LostWithin(9999us), 0U);
  EXPECT_EQ(LostWithin(1us), 1U);
}

TEST_F(SentHistoryTest, ALonePacketFarBehindIsNoRestart) {
  Send(40480, 40500);
  Send(10000, 10001);
  Send(40500, 40501);
  Send(10001, 10002);
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 21000);
  Send(12000, 12001);  // Two packets whose numbers are not consecutive are no restart, either.
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 21000);
}

TEST_F(SentHistoryTest, APacketThatWasOvertakenByManyOrAcknowledgedOnesDoesNotCount) {
  Send(0, 1);
  Send(2, 80);
  Send(1, 2);
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 79000);
  Send(81, 85);
  Apply(Report(79, "r-rr"));
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 2000);
  Send(80, 81);
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 2000);
}

TEST_F(SentHistoryTest, TheOldestInFlightMayBeOfAnySource) {
  Send(0, 2);
  history_.OnSent(2, 7, {0, DataSize::Bytes(1000), now_, Ecn::kEct1});
  EXPECT_EQ(history_.oldest_in_flight(), kStart);
}

TEST_F(SentHistoryTest, AnArrivalMayBeAsMuchTooEarlyAsReportsAreCoarse) {
  Send(0, 2);
  now_ = kStart + 10ms;
  rtcp::CongestionFeedback f = Report(0, "r");
  f.blocks[0].metrics[0].arrival_offset = 13ms;
  EXPECT_EQ(Apply(f), FeedbackResult::kImplausible);
  f.blocks[0].metrics[0].arrival_offset = 12ms;
  EXPECT_EQ(Apply(f), FeedbackResult::kAccepted);
}

TEST_F(SentHistoryTest, ManyPacketsOfTheLastSecondAreRemembered) {
  for (int seq = 0; seq < 3000; ++seq, now_ += 300us)
    history_.OnSent(1, static_cast<std::uint16_t>(seq),
                    {0, DataSize::Bytes(1000), now_, Ecn::kEct1});
  Apply(Report(0, std::string(3000, 'r')));
  Send(3000, 3001);
  EXPECT_EQ(Apply(Report(0, "C")), FeedbackResult::kAccepted);
  EXPECT_EQ(summary_.late_ce.size(), 1U);
}

TEST_F(SentHistoryTest, AMissingPacketThatExpiredIsNotLost) {
  Send(0, 20);
  Apply(Report(0, "r-r"));
  now_ += 20ms;
  Apply(Report(0, "rrr-r"));  // Packet 3 may be as late as packet 1 was.
  ASSERT_TRUE(summary_.lost.empty());
  history_.Expire(now_);
  EXPECT_EQ(LostWithin(1s), 0U);
}

TEST_F(SentHistoryTest, ARepeatedPacketIsNoRestart) {
  Send(0, 100);
  Send(40, 60);
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 100000);
  Send(100, 101);
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 101000);
}

TEST_F(SentHistoryTest, SomeRepeatedPacketsFarBehindAreNoRestart) {
  Send(0, 3100);
  Send(10, 30);
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 3'100'000);
}

TEST_F(SentHistoryTest, PacketsThatOvertookEachOtherBeforeTheyWereSentAllCount) {
  Send(0, 3);
  Send(5, 6);
  Send(3, 5);
  Send(6, 7);
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 7000);
  EXPECT_EQ(Apply(Report(0, "rrrrrr")), FeedbackResult::kAccepted);
  EXPECT_EQ(summary_.acked.size(), 6U);
}

TEST_F(SentHistoryTest, TheLostTailOfAQuietSourceDoesNotStayInFlight) {
  Send(0, 48);
  for (int seq = 0; seq < 1100; ++seq, now_ += 1ms)
    history_.OnSent(2, static_cast<std::uint16_t>(seq),
                    {0, DataSize::Bytes(1000), now_, Ecn::kEct1});
  Apply(Report(0, std::string(900, 'r'), 2));
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 248000) << "it may still be reported";
  Apply(Report(900, std::string(199, 'r'), 2));
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 1000);
  EXPECT_TRUE(summary_.lost.empty()) << "nobody knows whether it arrived";
  Apply(Report(0, "r"));
  ASSERT_EQ(summary_.acked.size(), 1U);
  EXPECT_FALSE(summary_.acked[0].arrival) << "it tells nothing about the path now";
}

TEST_F(SentHistoryTest, AReorderingWindowOfManyPacketsStillFindsLosses) {
  const auto send = [&](int from, int until) {  // sends at 1 Gbit/s
    for (int seq = from; seq < until; ++seq, now_ += 10us)
      history_.OnSent(1, static_cast<std::uint16_t>(seq),
                      {0, DataSize::Bytes(1250), now_, Ecn::kEct1});
  };
  send(0, 1000);
  Apply(Report(0, "r-r"));
  now_ += 15ms;
  Apply(Report(0, "rrr"));
  Apply(Report(3, "-r"));
  send(1000, 3000);
  std::string all(2995, 'r');
  Apply(Report(5, all));
  EXPECT_EQ(summary_.lost.size(), 1U);
}

TEST_F(SentHistoryTest, TheReorderingWindowShrinksWhereNothingOvertakesAnyMore) {
  Send(0, 20);
  Apply(Report(0, "r-r"));
  now_ += 8ms;
  Apply(Report(0, "rrr"));
  for (int i = 0; i < 60; ++i) LostWithin(1s);
  Apply(Report(3, "-r"));
  EXPECT_EQ(LostWithin(100us), 1U);
}

TEST_F(SentHistoryTest, ManyPacketsInFlightAreCounted) {
  for (int i = 0; i < 30000; ++i)
    history_.OnSent(1, static_cast<std::uint16_t>(i), {0, DataSize::Bytes(1000), now_, Ecn::kEct1});
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 30000 * 1000);
  EXPECT_FALSE(history_.full());

  for (int i = 30000; i < 32000; ++i)
    history_.OnSent(1, static_cast<std::uint16_t>(i), {0, DataSize::Bytes(1000), now_, Ecn::kEct1});
  EXPECT_TRUE(history_.full());
}

TEST_F(SentHistoryTest, RoundTripsIncludeTheHoldingTimeOfReceiversThatDoNotTellIt) {
  Send(0, 4);
  now_ = kStart + 43ms;
  rtcp::CongestionFeedback f = Report(0, "rrrr");
  for (rtcp::PacketMetric& m : f.blocks[0].metrics) m.arrival_offset.reset();
  Apply(f);
  ASSERT_TRUE(summary_.rtt);
  EXPECT_EQ(*summary_.rtt, Duration(40ms));
}

TEST_F(SentHistoryTest, MemoryStaysBoundedWithoutFeedback) {
  for (int i = 0; i < 100000; ++i)
    history_.OnSent(1, static_cast<std::uint16_t>(i), {0, DataSize::Bytes(1000), now_, Ecn::kEct1});
  EXPECT_EQ(history_.bytes_in_flight().bytes(), 32000 * 1000);
}

}  // namespace
}  // namespace lidar::scream
