// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/bonding/link_ledger.h"

#include <gtest/gtest.h>

#include "src/sim/simulated_time.h"

namespace lidar::bonding {
namespace {

using namespace std::chrono_literals;
using rtcp::CongestionFeedback;

constexpr std::uint32_t kSsrc = 9;

/// Returns a report on the packets `seq`, `seq` + 1, and so on. `arrived` says for each packet
/// whether it arrived.
CongestionFeedback ReportOf(std::uint16_t seq, const std::vector<bool>& arrived,
                            std::uint32_t ssrc = kSsrc) {
  CongestionFeedback feedback;
  rtcp::SsrcReport block{ssrc, seq, {}};
  for (const bool a : arrived) block.metrics.push_back({a, Ecn::kEct1, std::nullopt});
  feedback.blocks.push_back(block);
  return feedback;
}

std::vector<PacketId> IdsOf(const LinkLedger::Report& report) {
  std::vector<PacketId> ids;
  for (const LinkLedger::Arrival& arrival : report.arrived) ids.push_back(arrival.id);
  return ids;
}

TEST(LinkLedger, NumbersPacketsInTheOrderInWhichTheyLeave) {
  LinkLedger ledger;
  EXPECT_EQ(ledger.OnSent(kStart, {kSsrc, 65535}), 0);
  EXPECT_EQ(ledger.OnSent(kStart, {kSsrc, 4}), 1);
  EXPECT_EQ(ledger.OnSent(kStart, {kSsrc, 2}), 2) << "a copy of an older packet";
  EXPECT_EQ(ledger.OnSent(kStart, {kSsrc + 1, 2}), 0) << "another SSRC";
}

TEST(LinkLedger, WaitsSinceTheOldestOfAllSources) {
  LinkLedger ledger;
  ledger.OnSent(kStart, {kSsrc, 1});
  ledger.OnSent(kStart + 5ms, {kSsrc + 1, 1});
  EXPECT_EQ(ledger.waiting_since(), kStart);
  ledger.OnFeedback(ReportOf(1, {true}));
  EXPECT_EQ(ledger.waiting_since(), kStart + 5ms);
}

TEST(LinkLedger, GivesReportsInItsNumbers) {
  LinkLedger ledger;
  ledger.OnSent(kStart, {kSsrc, 100});
  ledger.OnSent(kStart, {kSsrc, 103});
  ledger.OnSent(kStart, {kSsrc, 101});
  const auto report = ledger.OnFeedback(ReportOf(100, {true, true, false, false}));
  ASSERT_TRUE(report);
  ASSERT_EQ(report->feedback.blocks.size(), 1U);
  const rtcp::SsrcReport& block = report->feedback.blocks.front();
  EXPECT_EQ(block.begin_seq, 0);
  ASSERT_EQ(block.metrics.size(), 3U);
  EXPECT_TRUE(block.metrics[0].received);
  EXPECT_FALSE(block.metrics[1].received);
  EXPECT_TRUE(block.metrics[2].received);
  EXPECT_EQ(IdsOf(*report), (std::vector<PacketId>{{kSsrc, 100}, {kSsrc, 101}}));
  EXPECT_EQ(report->missing, (std::vector<PacketId>{{kSsrc, 103}}));
  EXPECT_FALSE(ledger.waiting_since());
}

TEST(LinkLedger, TellsOnceWhatArrivedAndWhatIsMissing) {
  LinkLedger ledger;
  for (std::uint16_t seq = 1; seq <= 3; ++seq) ledger.OnSent(kStart, {kSsrc, seq});
  ledger.OnFeedback(ReportOf(1, {true, false, true}));
  const auto again = ledger.OnFeedback(ReportOf(1, {true, false, true}));
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->arrived.empty());
  EXPECT_TRUE(again->missing.empty());
  const auto late = ledger.OnFeedback(ReportOf(1, {true, true, true}));
  ASSERT_EQ(late->arrived.size(), 1U);
  EXPECT_EQ(late->arrived[0].id, (PacketId{kSsrc, 2}));
}

TEST(LinkLedger, RefusesWholeWhatTellsOfAPacketThatWentAnotherWay) {
  LinkLedger ledger;
  ledger.OnSent(kStart, {kSsrc, 1});
  EXPECT_FALSE(ledger.OnFeedback(ReportOf(1, {true, true})));
  EXPECT_EQ(ledger.waiting_since(), kStart) << "nothing of it was taken";
  const auto foreign = ledger.OnFeedback(ReportOf(1, {true}, kSsrc + 1));
  ASSERT_TRUE(foreign);
  EXPECT_EQ(foreign->feedback.blocks.size(), 1U) << "for the controller to count";
  EXPECT_TRUE(foreign->arrived.empty());
}

TEST(LinkLedger, TakesAReportInWhichNothingArrivedAsNoNews) {
  LinkLedger ledger;
  ledger.OnSent(kStart, {kSsrc, 1});
  const auto report = ledger.OnFeedback(ReportOf(1, {false, false}));
  ASSERT_TRUE(report) << "it names no packet of another link";
  EXPECT_TRUE(report->arrived.empty());
  EXPECT_TRUE(report->missing.empty());
  EXPECT_EQ(ledger.waiting_since(), kStart);
}

TEST(LinkLedger, WaitsForWhatLeftFirst) {
  LinkLedger ledger;
  EXPECT_FALSE(ledger.waiting_since());
  ledger.OnSent(kStart, {kSsrc, 1});
  ledger.OnSent(kStart + 10ms, {kSsrc, 2});
  EXPECT_EQ(ledger.waiting_since(), kStart);
  ledger.OnFeedback(ReportOf(1, {true}));
  EXPECT_EQ(ledger.waiting_since(), kStart + 10ms);
}

TEST(LinkLedger, ExpectsAReportAtTheEndOfASliceAndWithinFortyMilliseconds) {
  LinkLedger ledger;
  ledger.OnSent(kStart, {kSsrc, 1}, false);
  EXPECT_EQ(ledger.waiting_since(), kStart + 40ms);
  ledger.OnSent(kStart + 10ms, {kSsrc, 2}, true);
  EXPECT_EQ(ledger.waiting_since(), kStart + 10ms);
}

TEST(LinkLedger, ForgetsTheSourceThatIsSilentLongest) {
  LinkLedger ledger;
  for (std::uint32_t ssrc = 0; ssrc < LinkLedger::kMaxSources; ++ssrc)
    ledger.OnSent(kStart + ssrc * 1ms, {ssrc, 1});
  ledger.OnSent(kStart + 1s, {0, 2});  // The first source is not silent.
  ledger.OnSent(kStart + 1s, {1'000, 1});
  EXPECT_EQ(ledger.OnFeedback(ReportOf(1, {true, true}, 0))->arrived.size(), 2U);
  EXPECT_TRUE(ledger.OnFeedback(ReportOf(1, {true}, 1))->arrived.empty()) << "the oldest one";
  for (std::uint32_t ssrc = 2; ssrc < LinkLedger::kMaxSources; ++ssrc)
    EXPECT_EQ(ledger.OnFeedback(ReportOf(1, {true}, ssrc))->arrived.size(), 1U) << ssrc;
}

TEST(LinkLedger, WaitsForTheOldestThatItRemembers) {
  LinkLedger ledger;
  constexpr int kSent = 3 * static_cast<int>(LinkLedger::kMaxPackets);
  for (int i = 0; i < kSent; ++i)
    ledger.OnSent(kStart + i * 1ms, {kSsrc, static_cast<std::uint16_t>(i)});
  const int oldest = kSent - static_cast<int>(LinkLedger::kMaxPackets);
  EXPECT_EQ(ledger.waiting_since(), kStart + oldest * 1ms);
  const auto report = ledger.OnFeedback(ReportOf(static_cast<std::uint16_t>(kSent - 1), {true}));
  ASSERT_TRUE(report);
  EXPECT_EQ(report->missing.size(), LinkLedger::kMaxPackets - 1);
  EXPECT_EQ(report->missing.front().seq, static_cast<std::uint16_t>(oldest));
}

TEST(LinkLedger, ForgetsTheOldestOfManyAndGoesRoundTheNumbers) {
  LinkLedger ledger;
  std::uint16_t seq = 0;
  for (int i = 0; i < 200000; ++i) {
    const std::uint16_t number = ledger.OnSent(kStart + i * 1us, {kSsrc, seq});
    EXPECT_EQ(number, static_cast<std::uint16_t>(i));
    if (i % 1000 == 999) {
      const auto report = ledger.OnFeedback(ReportOf(seq, {true}));
      ASSERT_TRUE(report) << i;
      EXPECT_EQ(report->feedback.blocks.front().begin_seq, number);
      EXPECT_EQ(report->missing.size(), 999U);
    }
    ++seq;
  }
  EXPECT_FALSE(ledger.OnFeedback(ReportOf(static_cast<std::uint16_t>(seq - 9000), {true})));
  for (std::uint32_t ssrc = 0; ssrc < 1000; ++ssrc) ledger.OnSent(kStart + 1s, {ssrc, 1});
  EXPECT_TRUE(ledger.OnFeedback(ReportOf(1, {true}, 999)));
}

}  // namespace
}  // namespace lidar::bonding
