// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rtp/receiver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/core/rtp/stream.h"

namespace lidar::rtp {
namespace {

using std::chrono::milliseconds;
using test::AllSlices;
using test::DeliverAll;
using test::Sender;
using test::SenderOptions;
using test::Wire;
using Names = std::vector<std::string>;

Names operator+(Names a, const Names& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(Receiver, FollowsASenderThatRestartsWithANewSsrcAndLosesNothingOfIt) {
  SenderOptions second;
  second.ssrc = 0x99;
  second.sequence = 5;
  second.scan_number = 77;
  Receiver receiver(milliseconds(100));
  auto packets = Sender().Scans(0, 3);
  for (const Wire& w : Sender(second).Scans(10, 3)) packets.push_back(w);
  EXPECT_EQ(DeliverAll(&receiver, packets), AllSlices(0, 3) + AllSlices(10, 3));
  receiver.Finish();
  EXPECT_EQ(receiver.ssrc(), std::nullopt);
  EXPECT_EQ(receiver.accounts().restarts, 1U);
  EXPECT_EQ(receiver.accounts().slices.slices_lost, 0U);
  EXPECT_EQ(receiver.accounts().slices.scans_complete, 6U);
}

TEST(Receiver, FollowsASenderThatRestartsWithTheSameSsrc) {
  SenderOptions second;
  second.sequence = 5;
  second.scan_number = 1'000'000;
  second.slices = 2;
  Receiver receiver(milliseconds(100));
  auto packets = Sender().Scans(0, 3);
  for (const Wire& w : Sender(second).Scans(10, 3)) packets.push_back(w);
  EXPECT_EQ(DeliverAll(&receiver, packets), AllSlices(0, 3) + AllSlices(10, 3, 2));
  second.scan_number = 500;
  for (const Wire& w : Sender(second).Scans(20, 3)) DeliverAll(&receiver, {w});
  // No sensor makes a million scans in less than a second, so these are restarts and not outages.
  EXPECT_EQ(receiver.accounts().restarts, 2U);
  EXPECT_EQ(receiver.accounts().slices.slices_lost, 0U);
}

TEST(Receiver, DecodesNothingOfARestartedSenderByTheConfigOfTheOneBefore) {
  SenderOptions second;
  second.sequence = 5;
  second.scan_number = 1'000'000;
  // The config id is the same as before.
  second.config.fields = "x:F32:0,y:F32:4,z:F32:8,range:U32:12";
  Receiver receiver(milliseconds(100));
  DeliverAll(&receiver, Sender().Scans(0, 3));
  auto packets = Sender(second).Scans(10, 3);
  ASSERT_TRUE(packets.front().config);
  packets.erase(packets.begin());  // The config is lost.
  EXPECT_EQ(DeliverAll(&receiver, packets), Names{});
  std::vector<Wire> config;
  Sender(second).Config(&config);
  config.front().sent = packets.back().sent;
  for (const ReceivedSlice& slice : test::Deliver(&receiver, config.front()))
    EXPECT_EQ(slice.config->fields, second.config.fields);
}

TEST(Receiver, FollowsASenderThatRestartsWithTheSameSsrcWithoutAPause) {
  SenderOptions first;
  first.scan_number = 1'000;
  SenderOptions second;
  second.sequence = 5;
  second.scan_number = 500;
  Receiver receiver(milliseconds(100));
  DeliverAll(&receiver, Sender(first).Scans(0, 3));
  // The receiver follows a stream after a probation of three packets, which is less than its first
  // scan.
  EXPECT_EQ(DeliverAll(&receiver, Sender(second).Scans(3, 1)), AllSlices(3, 1));
  EXPECT_EQ(receiver.accounts().restarts, 1U);
}

class Outage : public ::testing::TestWithParam<std::uint32_t> {};
TEST_P(Outage, CountsEveryScanOfItOnceWhereverItBeginsAndEnds) {
  const std::uint32_t scans = GetParam();
  const auto all = Sender().Scans(0, scans + 10);
  for (std::uint32_t cut = 0; cut < 4; ++cut) {
    std::vector<Wire> through;
    for (const Wire& w : all) {
      // The link is down from slice `cut` of scan 5 until slice `cut` of scan 5 + `scans`.
      const std::uint32_t at = w.scan * 4 + w.index;
      if (w.config || at < 5 * 4 + cut || at >= (5 + scans) * 4 + cut) through.push_back(w);
    }
    Receiver receiver(milliseconds(100));
    DeliverAll(&receiver, through);
    receiver.Finish();
    const auto a = receiver.accounts();
    EXPECT_EQ(a.slices.slices_lost, scans * 4) << cut;
    EXPECT_EQ(a.slices.slices_received, 40U) << cut;
    // If the outage begins and ends within a scan, two scans are incomplete. One scan less is then
    // lost as a whole.
    EXPECT_EQ(a.slices.scans_incomplete, cut == 0 ? 0U : 2U) << cut;
    EXPECT_EQ(a.slices.scans_lost, cut == 0 ? scans : scans - 1) << cut;
    EXPECT_EQ(a.slices.scans_complete, cut == 0 ? 10U : 9U) << cut;
    // If scan numbers jump by two scans or less, the receiver counts no outage.
    EXPECT_EQ(a.outages, scans + (cut == 0 ? 1 : 0) > 2 ? 1U : 0U);
    EXPECT_EQ(a.restarts, 0U);
  }
}
INSTANTIATE_TEST_SUITE_P(Scans, Outage, ::testing::Values(1, 2, 3, 10, 100, 600, 6'000));

TEST(Receiver, KeepsAllItsCountsThroughOutagesAndRestarts) {
  SenderOptions options;
  auto all = Sender(options).Scans(0, 40);
  options.ssrc += 1;
  options.config_id += 1;
  const auto other = Sender(options).Scans(60, 40);
  all.insert(all.end(), other.begin(), other.end());
  Receiver receiver(milliseconds(100));
  ReceiverAccounts last;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].scan >= 10 && all[i].scan < 30) continue;  // This is an outage.
    const bool repeats = i % 10 == 3;
    for (int times = repeats ? 2 : 1; times > 0; --times) Deliver(&receiver, all[i]);
    const ReceiverAccounts now = receiver.accounts();
    EXPECT_GE(now.packets.duplicate, last.packets.duplicate) << i;
    EXPECT_GE(now.slices.slices_received, last.slices.slices_received) << i;
    EXPECT_GE(now.configs_received, last.configs_received) << i;
    last = now;
  }
  EXPECT_EQ(last.outages, 1U);
  EXPECT_EQ(last.restarts, 1U);
  EXPECT_EQ(last.configs_received, 2U);
  EXPECT_GT(last.packets.duplicate, 30U);
  receiver.Finish();
  EXPECT_EQ(receiver.accounts().packets.duplicate, last.packets.duplicate);
}

TEST(Receiver, GivesOutSlicesThatComeAloneAndFarApart) {
  SenderOptions options;
  options.slice_size = 1'500;  // Each slice has two packets.
  std::vector<Wire> through;
  for (const Wire& w : Sender(options).Scans(0, 60))
    if (w.config || (w.scan % 10 == 5 && w.index == 2)) through.push_back(w);
  Receiver receiver(milliseconds(100));
  EXPECT_EQ(DeliverAll(&receiver, through, 1'500),
            (Names{"5.2", "15.2", "25.2", "35.2", "45.2", "55.2"}));
  receiver.Finish();
  const auto a = receiver.accounts();
  // These are the slices between the first and the last one.
  EXPECT_EQ(a.slices.slices_lost, 5 * 39U);
  EXPECT_EQ(a.packets.invalid, 0U);
  EXPECT_EQ(a.outages, 5U);
  EXPECT_EQ(a.restarts, 0U);
}

TEST(Receiver, GivesOutSlicesFromFarApartThatComeAllAtOnce) {
  // Packets wait at the sender until 1.5 s, as behind a link without capacity.
  SenderOptions options;
  options.slice_size = 1'500;
  std::vector<Wire> through;
  for (Wire& w : Sender(options).Scans(0, 80)) {
    if (!w.config && (w.scan % 10 != 5 || w.index != 2)) continue;
    if (w.scan < 70) w.sent = std::min(w.sent, Time{milliseconds(1'500)});
    through.push_back(w);
  }
  Receiver receiver(milliseconds(100));
  EXPECT_EQ(DeliverAll(&receiver, through, 1'500),
            (Names{"5.2", "15.2", "25.2", "35.2", "45.2", "55.2", "65.2", "75.2"}));
  receiver.Finish();
  EXPECT_EQ(receiver.accounts().slices.slices_lost, 7 * 39U);
  EXPECT_EQ(receiver.accounts().restarts, 0U);
}

TEST(Receiver, JoinsWithinASliceAndGoesOnAfterALossOfScans) {
  std::vector<Wire> through;
  for (const Wire& w : Sender().Scans(0, 10))
    if (w.config || (w.scan == 0 && w.index == 3 && w.marker) || w.scan >= 5) through.push_back(w);
  Receiver receiver(milliseconds(100));
  EXPECT_EQ(DeliverAll(&receiver, through), AllSlices(5, 5));
  receiver.Finish();
  const auto a = receiver.accounts();
  EXPECT_EQ(a.restarts, 0U);
  EXPECT_EQ(a.outages, 0U);
  EXPECT_EQ(a.slices.slices_lost, 0U);
  EXPECT_EQ(a.packets.invalid, 0U);
}

TEST(Receiver, IsNotMovedByADamagedPacketBeforeItsFirstSlice) {
  auto packets = Sender().Scans(0, 10);
  SenderOptions far;
  far.scan_number += 0x4000'0000;
  Wire wild = Sender(far).Scans(0, 1).back();  // It does not begin a slice.
  packets.insert(packets.begin() + 1, wild);
  Receiver receiver(milliseconds(100));
  EXPECT_EQ(DeliverAll(&receiver, packets), AllSlices(0, 10));
  EXPECT_EQ(receiver.accounts().restarts, 0U);
}

TEST(Receiver, IsNotMovedByOnePacketThatClaimsAnotherPlaceOrSsrc) {
  SenderOptions real;
  real.scan_number = 1'000;
  Sender sender(real);
  SenderOptions far;
  far.scan_number = 123'456;
  far.slice_size = 300;  // One packet has the whole slice.
  SenderOptions foreign;
  foreign.ssrc = 1;
  Sender a(far);
  Sender b(foreign);
  std::vector<Wire> packets;
  for (const Wire& w : sender.Scans(0, 30)) {
    packets.push_back(w);
    if (w.scan == 0) continue;
    Wire wild = (w.sequence % 2 != 0 ? a : b).Scans(w.scan, 1).back();
    wild.sent = w.sent;
    packets.push_back(wild);
  }
  Receiver receiver(milliseconds(100));
  EXPECT_EQ(DeliverAll(&receiver, packets), AllSlices(0, 30));
  EXPECT_EQ(receiver.ssrc(), SenderOptions{}.ssrc);
  EXPECT_EQ(receiver.accounts().restarts + receiver.accounts().outages, 0U);
}

TEST(Receiver, IsNotMovedByAWholeStreamOfAnotherWhileItsOwnGoesOn) {
  SenderOptions foreign;
  foreign.ssrc = 1;
  const auto own = Sender().Scans(0, 60);
  const auto other = Sender(foreign).Scans(0, 60);
  std::vector<Wire> packets;
  for (std::size_t i = 0; i < own.size(); ++i) {
    packets.push_back(own[i]);
    packets.push_back(other[i]);
  }
  Receiver receiver(milliseconds(100));
  EXPECT_EQ(DeliverAll(&receiver, packets), AllSlices(0, 60));
  EXPECT_EQ(receiver.ssrc(), SenderOptions{}.ssrc);
  EXPECT_EQ(receiver.accounts().restarts, 0U);
}

class AnotherStream : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Reordered, AnotherStream, ::testing::Bool());

TEST_P(AnotherStream, IsNotHeldWhileTheStreamGoesOn) {
  SenderOptions foreign;
  foreign.ssrc = 1;
  const auto own = Sender().Scans(0, 60);
  auto other = Sender(foreign).Scans(0, 70);
  // With reordered packets, the end of each slice arrives after the begin of the next slice, so
  // that there is always an incomplete slice.
  for (std::size_t end = 3; GetParam() && end + 1 < other.size(); end += 3)
    std::swap(other[end], other[end + 1]);
  Receiver receiver(milliseconds(100));
  for (std::size_t i = 0; i < own.size(); ++i) DeliverAll(&receiver, {own[i], other[i]});
  std::vector<ReceivedSlice> moved;
  for (std::size_t i = own.size(); i < other.size(); ++i)
    for (ReceivedSlice& slice : test::Deliver(&receiver, other[i])) moved.push_back(slice);
  ASSERT_EQ(moved.size(), 41U);
  // Only the end of this slice arrives after the first stream.
  EXPECT_EQ(moved.front().info.scan_id, 59U);
  EXPECT_TRUE(moved.front().discont);
  EXPECT_FALSE(moved[1].discont);
  receiver.Finish();
  EXPECT_EQ(receiver.accounts().slices.slices_received, 60 * 4 + moved.size());
  EXPECT_EQ(receiver.accounts().slices.slices_lost, 0U);
  EXPECT_EQ(receiver.accounts().slices.scans_complete, 60U + 10);
}

TEST(Receiver, KeepsTheStreamAmongAHundredTimesAsMuchGarbage) {
  std::mt19937 random(1);
  Receiver receiver(milliseconds(100));
  Names names;
  for (const Wire& w : Sender().Scans(0, 5)) {
    for (const auto& n : DeliverAll(&receiver, {w})) names.push_back(n);
    for (int i = 0; i < 100; ++i) {
      Wire garbage = w;
      garbage.ssrc = static_cast<std::uint32_t>(random());
      garbage.sequence = static_cast<std::uint16_t>(random());
      garbage.payload.resize(1 + random() % 1'400);
      for (auto& b : garbage.payload) b = static_cast<std::uint8_t>(random());
      for (const auto& n : DeliverAll(&receiver, {garbage})) names.push_back(n + " from garbage");
    }
  }
  EXPECT_EQ(names, AllSlices(0, 5));
  EXPECT_GT(receiver.accounts().packets.invalid, 6'000U);
}

TEST(Receiver, SurvivesMutationsOfEveryPacket) {
  std::mt19937 random(2);
  const auto packets = Sender().Scans(0, 20);
  for (int round = 0; round < 50; ++round) {
    Receiver receiver(milliseconds(20));
    for (Wire w : packets) {
      for (int i = 0; i < 3; ++i) {
        auto& byte = w.payload[random() % std::min<std::size_t>(w.payload.size(), 48)];
        if (random() % 4 == 0) byte = static_cast<std::uint8_t>(random());
      }
      for (const auto& n : DeliverAll(&receiver, {w}))
        ASSERT_EQ(n.find("differs"), std::string::npos);
    }
    receiver.Finish();
  }
}

TEST(Receiver, StartsAnewAfterTheEnd) {
  Receiver receiver(milliseconds(100));
  EXPECT_EQ(DeliverAll(&receiver, Sender().Scans(0, 1)), AllSlices(0, 1));
  receiver.Finish();
  EXPECT_EQ(DeliverAll(&receiver, Sender().Scans(0, 1)), AllSlices(0, 1));
  EXPECT_EQ(receiver.accounts().slices.slices_received, 8U);
}

TEST(Receiver, WaitsForLatePacketsAsLongAsWasSetBeforeAFlush) {
  Receiver receiver(milliseconds(100));
  EXPECT_EQ(DeliverAll(&receiver, Sender().Scans(0, 1)), AllSlices(0, 1));
  receiver.set_max_reorder_time(milliseconds(1'000));
  receiver.Finish();
  auto packets = Sender().Scans(0, 8);
  const auto late = std::find_if(packets.begin(), packets.end(),
                                 [](const Wire& w) { return w.scan == 1 && w.index == 1; });
  ASSERT_NE(late, packets.end());
  const Wire packet = *late;
  packets.erase(late);
  DeliverAll(&receiver, packets);
  EXPECT_EQ(receiver.accounts().slices.slices_received, 35U);
  EXPECT_EQ(DeliverAll(&receiver, {packet}), Names{"1.1"});
}

TEST(Receiver, WaitsForLatePacketsOfAStreamThatIsAboutToBeFollowedAsLongAsWasSet) {
  SenderOptions second;
  second.ssrc = 0x99;
  Receiver receiver(milliseconds(100));
  DeliverAll(&receiver, Sender().Scans(0, 1));
  auto packets = Sender(second).Scans(10, 8);
  const auto late = std::find_if(packets.begin(), packets.end(),
                                 [](const Wire& w) { return w.scan == 11 && w.index == 1; });
  ASSERT_NE(late, packets.end());
  const Wire packet = *late;
  packets.erase(late);
  DeliverAll(&receiver, {packets.front()});
  receiver.set_max_reorder_time(milliseconds(1'000));
  DeliverAll(&receiver, {packets.begin() + 1, packets.end()});
  EXPECT_EQ(receiver.ssrc(), second.ssrc);
  EXPECT_EQ(receiver.accounts().slices.slices_received, 4U + 31);
  EXPECT_EQ(DeliverAll(&receiver, {packet}), Names{"11.1"});
}

}  // namespace
}  // namespace lidar::rtp
