// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rtp/reassembler.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/core/rtp/stream.h"

namespace lidar::rtp {
namespace {

using std::chrono::milliseconds;
using test::AllSlices;
using test::DeliverAll;
using test::kReorder;
using test::Sender;
using test::SenderOptions;
using test::Wire;
using Names = std::vector<std::string>;

/// Returns the accounts in one line.
std::string Accounts(const Receiver& r) {
  const SliceAccounts a = r.accounts().slices;
  return "received " + std::to_string(a.slices_received) + " lost " +
         std::to_string(a.slices_lost) + " damaged " + std::to_string(a.slices_damaged) +
         " mismatch " + std::to_string(a.slices_config_mismatch) + "; scans " +
         std::to_string(a.scans_complete) + " " + std::to_string(a.scans_incomplete) + " " +
         std::to_string(a.scans_lost);
}

std::string AccountsAfter(const std::vector<Wire>& packets) {
  Receiver receiver(kReorder);
  DeliverAll(&receiver, packets);
  receiver.Finish();
  return Accounts(receiver);
}

Names Without(Names all, const Names& missing) {
  for (const auto& m : missing) all.erase(std::find(all.begin(), all.end(), m));
  return all;
}

TEST(Stream, ArrivesWholeAcrossTheWrapOfSequenceAndScanNumbers) {
  Receiver receiver(kReorder);
  Sender sender;
  EXPECT_EQ(DeliverAll(&receiver, sender.Scans(0, 100)), AllSlices(0, 100));
  receiver.Finish();
  EXPECT_EQ(Accounts(receiver), "received 400 lost 0 damaged 0 mismatch 0; scans 100 0 0");
  EXPECT_EQ(receiver.accounts().packets.invalid, 0U);
}

TEST(Stream, GivesBackAllThatWasSaidOfASlice) {
  Receiver receiver(kReorder);
  Sender sender;
  std::vector<ReceivedSlice> got;
  for (const Wire& w : sender.Scans(0, 1))
    for (auto& s : test::Deliver(&receiver, w)) got.push_back(std::move(s));
  ASSERT_EQ(got.size(), 4U);
  EXPECT_EQ(got[3].id.index, 3);
  EXPECT_EQ(got[3].id.count, 4);
  EXPECT_EQ(got[3].info.first_column, 300);
  EXPECT_EQ(got[3].info.duration_ns, 25'000'000U);
  EXPECT_EQ(got[3].info.capture_ntp, 7U);
  EXPECT_EQ(got[3].pts, Time{milliseconds(75)});
  EXPECT_EQ(*got[3].config, test::SmallConfig());
  EXPECT_TRUE(got[0].discont);
  EXPECT_FALSE(got[1].discont);
}

// Drops each packet of three scans in turn. Only the slice that the packet belongs to may be lost.
TEST(Loss, OfAnyOnePacketCostsItsSliceOnly) {
  const auto packets = Sender().Scans(0, 3);
  for (std::size_t drop = 0; drop < packets.size(); ++drop) {
    if (packets[drop].config) continue;
    auto left = packets;
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(drop));
    Receiver receiver(kReorder);
    const std::string lost =
        std::to_string(packets[drop].scan) + "." + std::to_string(packets[drop].index);
    ASSERT_EQ(DeliverAll(&receiver, left), Without(AllSlices(0, 3), {lost})) << drop;
    receiver.Finish();
    // If a packet of the first slice is lost, the receiver joins after that slice and does not
    // count it.
    if (lost == "0.0") continue;
    ASSERT_EQ(Accounts(receiver), "received 11 lost 1 damaged 0 mismatch 0; scans 2 1 0") << drop;
  }
}

TEST(Loss, OfOneSliceMarksTheNextOneDiscontinuousOnce) {
  auto packets = Sender().Scans(0, 4);
  Lose(&packets, [](const Wire& w) { return w.scan == 1 && w.index == 2; });
  Receiver receiver(milliseconds(0));
  Names discont;
  for (const Wire& w : packets)
    for (const auto& s : test::Deliver(&receiver, w))
      if (s.discont)
        discont.push_back(std::to_string(s.info.scan_id) + "." + std::to_string(s.id.index));
  EXPECT_EQ(discont, (Names{"0.0", "1.3"}));
}

TEST(Damage, MarksTheNextSliceDiscontinuousWhateverWasLostBefore) {
  auto packets = Sender().Scans(0, 4);
  for (Wire& w : packets)
    if (w.scan == 2 && w.index == 0 && !w.config) w.payload.back() ^= 1;
  Lose(&packets, [](const Wire& w) { return w.scan == 1 && w.index < 2; });
  Receiver receiver(milliseconds(0));
  Names discont;
  for (const Wire& w : packets)
    for (const auto& s : test::Deliver(&receiver, w))
      if (s.discont)
        discont.push_back(std::to_string(s.info.scan_id) + "." + std::to_string(s.id.index));
  EXPECT_EQ(discont, (Names{"0.0", "1.2", "2.1"}));
}

TEST(Loss, OfWholeScansCountsEachSliceAndScanOnce) {
  auto packets = Sender().Scans(0, 10);
  Lose(&packets,
       [](const Wire& w) { return (w.scan == 3 || w.scan == 6) || (w.scan == 4 && w.index < 2); });
  EXPECT_EQ(AccountsAfter(packets), "received 30 lost 10 damaged 0 mismatch 0; scans 7 1 2");
}

TEST(Loss, OfTheLastPacketIsCountedAtTheEnd) {
  auto packets = Sender().Scans(0, 2);
  packets.pop_back();
  Receiver receiver(kReorder);
  DeliverAll(&receiver, packets);
  EXPECT_EQ(Accounts(receiver), "received 7 lost 0 damaged 0 mismatch 0; scans 1 0 0");
  receiver.Finish();
  EXPECT_EQ(Accounts(receiver), "received 7 lost 1 damaged 0 mismatch 0; scans 1 1 0");
}

TEST(Loss, AgreesWithTheLinkAtEveryRate) {
  for (const unsigned percent : {5U, 20U, 50U, 90U}) {
    const auto packets = Sender().Scans(0, 300);
    std::uint32_t random = percent;
    std::vector<Wire> through;
    std::vector<std::vector<unsigned>> dropped(300, std::vector<unsigned>(4));
    for (const Wire& w : packets) {
      random = random * 1664525U + 1013904223U;
      // The first slice always arrives, so that the receiver begins to count where the expected
      // counts begin. The last slice always arrives, so that the receiver notices the losses before
      // it.
      const bool edge =
          w.config || (w.scan == 0 && w.index == 0) || (w.scan == 299 && w.index == 3);
      if ((random >> 8) % 100 < percent && !edge) {
        ++dropped[w.scan][w.index];
      } else {
        through.push_back(w);
      }
    }
    Receiver receiver(kReorder);
    const auto got = DeliverAll(&receiver, through);
    receiver.Finish();
    SliceAccounts expected;
    for (const auto& scan : dropped) {
      const auto lost = static_cast<unsigned>(
          std::count_if(scan.begin(), scan.end(), [](unsigned d) { return d > 0; }));
      expected.slices_lost += lost;
      expected.slices_received += 4 - lost;
      ++(lost == 0   ? expected.scans_complete
         : lost == 4 ? expected.scans_lost
                     : expected.scans_incomplete);
    }
    const SliceAccounts a = receiver.accounts().slices;
    EXPECT_EQ(a.slices_lost, expected.slices_lost) << percent;
    EXPECT_EQ(a.slices_received, expected.slices_received) << percent;
    EXPECT_EQ(a.scans_complete, expected.scans_complete) << percent;
    EXPECT_EQ(a.scans_incomplete, expected.scans_incomplete) << percent;
    EXPECT_EQ(a.scans_lost, expected.scans_lost) << percent;
    EXPECT_EQ(got.size(), expected.slices_received);
  }
}

TEST(Reordering, ByTwentyPacketsLosesNothing) {
  auto packets = Sender().Scans(0, 20);
  for (std::size_t i = 0; i + 20 < packets.size(); i += 21) {
    // Moves the packet behind the next 20 packets. It is sent at the time of the last of them.
    Wire late = packets[i];
    late.sent = packets[i + 20].sent;
    packets.erase(packets.begin() + static_cast<std::ptrdiff_t>(i));
    packets.insert(packets.begin() + static_cast<std::ptrdiff_t>(i + 20), late);
  }
  Receiver receiver(milliseconds(200));
  auto names = DeliverAll(&receiver, packets);
  EXPECT_NE(names, AllSlices(0, 20));  // A slice did not wait for the slices before it.
  auto all = AllSlices(0, 20);
  std::sort(names.begin(), names.end());
  std::sort(all.begin(), all.end());
  receiver.Finish();
  // The config was moved, too. The first slices waited for the config.
  EXPECT_EQ(names, all);
  EXPECT_EQ(Accounts(receiver), "received 80 lost 0 damaged 0 mismatch 0; scans 20 0 0");
}

TEST(Reordering, PastTheLimitIsALossThatIsNotTakenBack) {
  auto packets = Sender().Scans(0, 10);
  const auto it = std::find_if(packets.begin(), packets.end(),
                               [](const Wire& w) { return w.scan == 2 && w.index == 1; });
  Wire late = *it;
  packets.erase(it);
  late.sent = packets.back().sent;
  packets.push_back(late);
  Receiver receiver(kReorder);
  EXPECT_EQ(DeliverAll(&receiver, packets), Without(AllSlices(0, 10), {"2.1"}));
  EXPECT_EQ(receiver.accounts().packets.late, 1U);
  receiver.Finish();
  EXPECT_EQ(Accounts(receiver), "received 39 lost 1 damaged 0 mismatch 0; scans 9 1 0");
}

TEST(Duplicates, OfEveryPacketChangeNothing) {
  std::vector<Wire> twice;
  for (const Wire& w : Sender().Scans(0, 5)) {
    twice.push_back(w);
    twice.push_back(w);
  }
  Receiver receiver(kReorder);
  EXPECT_EQ(DeliverAll(&receiver, twice), AllSlices(0, 5));
  receiver.Finish();
  EXPECT_EQ(Accounts(receiver), "received 20 lost 0 damaged 0 mismatch 0; scans 5 0 0");
  EXPECT_EQ(receiver.accounts().packets.duplicate, 60U);
}

TEST(Damage, OfAnyByteOfASliceIsNeverShown) {
  const auto packets = Sender().Scans(0, 2);
  const auto victim = static_cast<std::size_t>(
      std::find_if(packets.begin(), packets.end(),
                   [](const Wire& w) { return w.scan == 1 && w.index == 1; }) -
      packets.begin());
  // Each byte of the packet is damaged in turn, the header included, because a slice with a wrong
  // time is as bad as a slice with wrong contents.
  for (std::size_t byte = 0; byte < packets[victim].payload.size(); ++byte) {
    auto damaged = packets;
    damaged[victim].payload[byte] ^= 0x10;
    Receiver receiver(milliseconds(0));
    for (const auto& name : DeliverAll(&receiver, damaged)) {
      ASSERT_EQ(name.find("differs"), std::string::npos) << byte;
      ASSERT_NE(name, "1.1") << byte;
    }
  }
}

TEST(Damage, IsCountedOnce) {
  auto packets = Sender().Scans(0, 2);
  packets.back().payload.back() ^= 1;
  EXPECT_EQ(AccountsAfter(packets), "received 7 lost 0 damaged 1 mismatch 0; scans 1 1 0");
}

TEST(Damage, TakesNoMemory) {
  auto packets = Sender().Scans(0, 2);
  packets.back().payload.back() ^= 1;
  Reassembler reassembler(kReorder);
  std::vector<ReceivedSlice> out;
  for (const Wire& w : packets)
    reassembler.Push({w.ssrc, w.sequence, w.sent, std::nullopt, ByteView{}},
                     ParsePayload({w.payload.data(), w.payload.size()}), &out);
  EXPECT_EQ(out.size(), 7U);
  EXPECT_EQ(reassembler.slices().slices_damaged, 1U);
  EXPECT_EQ(reassembler.pending_bytes(), 0U);
}

TEST(Join, InMidStreamStartsWithTheFirstSliceThatIsWholeAfterAConfig) {
  Sender sender;
  auto packets = sender.Scans(0, 3);
  sender.Config(&packets);
  for (std::uint16_t i = 0; i < 4; ++i) sender.Slice(3, i, &packets);
  for (std::uint16_t i = 0; i < 4; ++i) sender.Slice(4, i, &packets);
  // The stream begins with the second packet of slice 1.2.
  const auto from = std::find_if(packets.begin(), packets.end(),
                                 [](const Wire& w) { return w.scan == 1 && w.index == 2; });
  packets.erase(packets.begin(), from + 1);
  Receiver receiver(milliseconds(20));
  // When the config arrived, slices 2.2 and 2.3 were still waiting for it. Earlier slices had been
  // given up.
  EXPECT_EQ(DeliverAll(&receiver, packets),
            (Names{"2.2", "2.3", "3.0", "3.1", "3.2", "3.3", "4.0", "4.1", "4.2", "4.3"}));
  receiver.Finish();
  // Scan 1 is not counted, because it began before the receiver joined.
  EXPECT_EQ(Accounts(receiver), "received 10 lost 0 damaged 0 mismatch 3; scans 2 1 0");
}

TEST(Config, OfAnotherIdIsAMismatchUntilItComes) {
  Sender sender;
  auto packets = sender.Scans(0, 2);
  SenderOptions changed;
  changed.config_id = 10;
  changed.sequence = static_cast<std::uint16_t>(packets.back().sequence + 1);
  Sender after(changed);
  for (std::uint16_t i = 0; i < 4; ++i) after.Slice(2, i, &packets);
  for (std::uint16_t i = 0; i < 4; ++i) after.Slice(3, i, &packets);
  after.Config(&packets);
  for (std::uint16_t i = 0; i < 4; ++i) after.Slice(4, i, &packets);
  Receiver receiver(milliseconds(0));
  auto expected = AllSlices(0, 2);
  for (const char* n : {"3.3", "4.0", "4.1", "4.2", "4.3"}) expected.emplace_back(n);
  EXPECT_EQ(DeliverAll(&receiver, packets), expected);
  receiver.Finish();
  EXPECT_EQ(Accounts(receiver), "received 13 lost 0 damaged 0 mismatch 7; scans 3 1 1");
}

TEST(Config, InFragmentsSurvivesReorderingAndDoesNotMixRepetitions) {
  SenderOptions o;
  o.max_payload = kMinPayload;
  o.slice_size = 20;
  Sender sender(o);
  std::vector<Wire> packets;
  sender.Config(&packets);
  ASSERT_GE(packets.size(), 3U);
  packets.pop_back();
  sender.Config(&packets);
  std::swap(packets[packets.size() - 1], packets[packets.size() - 2]);
  sender.Slice(0, 0, &packets);
  Receiver receiver(kReorder);
  EXPECT_EQ(DeliverAll(&receiver, packets, 20), Names{"0.0"});
  EXPECT_EQ(receiver.accounts().packets.config_damaged, 0U);
  EXPECT_EQ(receiver.accounts().configs_received, 1U);
}

TEST(Config, InFragmentsSurvivesARepeatedFirstOne) {
  SenderOptions o;
  o.max_payload = kMinPayload;
  o.slice_size = 20;
  Sender sender(o);
  std::vector<Wire> packets;
  sender.Config(&packets);
  ASSERT_GE(packets.size(), 3U);
  packets.insert(packets.end() - 1, packets.front());
  sender.Slice(0, 0, &packets);
  Receiver receiver(kReorder);
  EXPECT_EQ(DeliverAll(&receiver, packets, 20), Names{"0.0"});
  EXPECT_EQ(receiver.accounts().configs_received, 1U);
}

TEST(Config, ThatIsRepeatedIsTheSameObject) {
  Sender sender;
  auto packets = sender.Scans(0, 1);
  sender.Config(&packets);
  sender.Slice(1, 0, &packets);
  Receiver receiver(kReorder);
  std::vector<std::shared_ptr<const StreamConfig>> configs;
  for (const Wire& w : packets)
    for (const auto& s : test::Deliver(&receiver, w)) configs.push_back(s.config);
  ASSERT_EQ(configs.size(), 5U);
  EXPECT_EQ(configs[0], configs[4]) << "so caps are set once";
}

TEST(Memory, IsBoundedAgainstSlicesThatNeverEnd) {
  // The stream has only middle fragments, one per slice. There are more slices than may be pending.
  Sender sender;
  auto packets = sender.Scans(0, 1);
  Reassembler reassembler(std::chrono::hours(1));
  std::vector<ReceivedSlice> out;
  std::uint16_t sequence = 0;
  const std::vector<std::uint8_t> body(60'000, 7);
  for (std::uint32_t i = 0; i < 3'000; ++i) {
    Unit unit;
    unit.type = PacketType::kMiddleFragment;
    unit.slice = {i / 4'096, static_cast<std::uint16_t>(i % 4'096), 4'096};
    unit.body = {body.data(), body.size()};
    RtpPacket packet;
    packet.sequence = ++sequence;
    reassembler.Push(packet, {unit}, &out);
    ASSERT_LE(reassembler.pending_bytes(), Reassembler::kMaxPendingBytes);
  }
  EXPECT_GT(reassembler.pending_bytes(), Reassembler::kMaxPendingBytes / 2);
}

TEST(Memory, KeepsNoMoreOfAConfigThanAUnitMayHold) {
  Reassembler reassembler(kReorder);
  std::vector<ReceivedSlice> out;
  const std::vector<std::uint8_t> body(60'000, 7);
  const auto push = [&](PacketType type, std::uint16_t sequence) {
    Unit unit;
    unit.type = type;
    unit.unit = UnitType::kStreamConfig;
    unit.body = {body.data(), body.size()};
    RtpPacket packet;
    packet.sequence = sequence;
    reassembler.Push(packet, {unit}, &out);
  };
  for (std::uint16_t i = 1; i <= 80; ++i) push(PacketType::kMiddleFragment, i);
  push(PacketType::kFirstFragment, 0);
  push(PacketType::kLastFragment, 81);
  EXPECT_EQ(reassembler.packets().config_damaged, 0U) << "the config is whole";
}

TEST(Memory, ThatASliceHadToLeaveIsALoss) {
  constexpr std::uint16_t kMost = Reassembler::kMaxPendingSlices;
  Reassembler reassembler(std::chrono::hours(1));
  std::vector<ReceivedSlice> out;
  const std::vector<std::uint8_t> body(10, 7);
  const auto begin = [&](std::uint16_t index) {
    Unit unit;
    unit.type = PacketType::kFirstFragment;
    unit.slice = {0, index, 4'096};
    unit.length = 1'000;
    unit.body = {body.data(), body.size()};
    RtpPacket packet;
    packet.sequence = index;
    reassembler.Push(packet, {unit}, &out);
  };
  for (std::uint16_t i = 0; i < kMost + 6; ++i) begin(i);
  EXPECT_EQ(reassembler.slices().slices_lost, 6U);
  begin(5);
  EXPECT_EQ(reassembler.packets().late, 1U);
  begin(6);
  EXPECT_EQ(reassembler.packets().duplicate, 1U);
  EXPECT_EQ(reassembler.slices().slices_lost, 6U);
}

}  // namespace
}  // namespace lidar::rtp
