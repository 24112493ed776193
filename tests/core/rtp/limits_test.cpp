// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests the limits of each part of the RTP format.
#include <gtest/gtest.h>

#include <map>

#include "src/rtp/delivery.h"
#include "src/rtp/fragment_buffer.h"
#include "src/rtp/slice_ledger.h"
#include "src/rtp/unit_check.h"
#include "tests/core/rtp/stream.h"

namespace lidar::rtp {
namespace {

using Stored = FragmentBuffer::Added;

Unit PieceOf(PacketType type, ByteView body) {
  Unit unit;
  unit.type = type;
  unit.body = body;
  return unit;
}

class FragmentLimits : public ::testing::Test {
 protected:
  Stored First(std::uint16_t seq) { return Add(seq, PacketType::kFirstFragment); }
  Stored Middle(std::uint16_t seq) { return Add(seq, PacketType::kMiddleFragment); }
  Stored Last(std::uint16_t seq) { return Add(seq, PacketType::kLastFragment); }

  FragmentBuffer buffer;

 private:
  Stored Add(std::uint16_t seq, PacketType type) {
    const std::uint8_t body[5] = {1, 2, 3, 4, 5};
    return buffer.Add(seq, PieceOf(type, {body, sizeof body}));
  }
};

TEST_F(FragmentLimits, BeforeTheFirstAreNoneOfTheUnit) {
  EXPECT_EQ(Middle(10), Stored::kStored);
  const std::size_t one = buffer.cost();
  EXPECT_EQ(First(11), Stored::kStored);
  EXPECT_EQ(buffer.cost(), one);
  EXPECT_EQ(Middle(10), Stored::kContradiction);
  EXPECT_EQ(First(12), Stored::kContradiction);
  EXPECT_EQ(First(11), Stored::kDuplicate);
  EXPECT_EQ(Last(12), Stored::kStored);
  EXPECT_TRUE(buffer.IsWhole());
  EXPECT_EQ(buffer.cost(), 2 * one);
}

TEST_F(FragmentLimits, BehindTheLastAreNoneOfTheUnit) {
  EXPECT_EQ(Middle(14), Stored::kStored);
  const std::size_t one = buffer.cost();
  EXPECT_EQ(Last(13), Stored::kStored);
  EXPECT_EQ(buffer.cost(), one);
  EXPECT_EQ(Middle(14), Stored::kContradiction);
  EXPECT_EQ(Last(12), Stored::kContradiction);
  EXPECT_EQ(First(11), Stored::kStored);
  EXPECT_FALSE(buffer.IsWhole());
  EXPECT_EQ(Middle(12), Stored::kStored);
  EXPECT_TRUE(buffer.IsWhole());
}

TEST(AggregateLimits, APacketIsFilledToTheLastByte) {
  const auto bytes = test::SliceBytes(1, 0, 100);
  const std::size_t exact =
      1 + kAggregateUnitSize + HeaderSize(PacketType::kSingle, UnitType::kSlice) + bytes.size();
  Aggregator aggregator;
  EXPECT_FALSE(aggregator.Add({}, {bytes.data(), bytes.size()}, exact - 1, 0));
  EXPECT_TRUE(aggregator.Add({}, {bytes.data(), bytes.size()}, exact, 0));
  EXPECT_FALSE(aggregator.Add({}, {bytes.data(), bytes.size()}, 2 * exact - 2, 0));
  EXPECT_TRUE(aggregator.Add({}, {bytes.data(), bytes.size()}, 2 * exact - 1, 0));
}

TEST(AggregateLimits, AllSlicesAreOfOneScanWithOneCount) {
  for (const std::uint16_t count : {std::uint16_t{4}, std::uint16_t{5}}) {
    Aggregator aggregator;
    const auto bytes = test::SliceBytes(1, 0, 50);
    Unit unit;
    unit.slice = {7, 0, 4};
    ASSERT_TRUE(aggregator.Add(unit, {bytes.data(), bytes.size()}, 1'000, 0));
    unit.slice = {7, 1, count};
    ASSERT_TRUE(aggregator.Add(unit, {bytes.data(), bytes.size()}, 1'000, 0));
    auto payload = aggregator.Take()->header;
    EXPECT_EQ(ParsePayload({payload.data(), payload.size()}).size(), count == 4 ? 2U : 0U);
    payload[0] = static_cast<std::uint8_t>(payload[0] | 16);  // the unit type of an aggregate is 0
    EXPECT_TRUE(ParsePayload({payload.data(), payload.size()}).empty());
  }
}

TEST(ConfigLimits, AFramerateIsTwoPositiveNumbersOf31Bits) {
  constexpr std::uint32_t kMost = 0x7FFF'FFFF;
  const auto taken = [](std::uint32_t n, std::uint32_t d) {
    StreamConfig config = test::SmallConfig();
    config.framerate_n = n;
    config.framerate_d = d;
    const auto bytes = config.Serialise();
    return StreamConfig::Parse({bytes.data(), bytes.size()}).has_value();
  };
  EXPECT_TRUE(taken(0, 1));
  EXPECT_TRUE(taken(kMost, kMost));
  EXPECT_FALSE(taken(kMost + 1, 1));
  EXPECT_FALSE(taken(1, kMost + 1));
  EXPECT_FALSE(taken(1, 0));
}

TEST(ConfigLimits, ConfigsDifferByEachOfTheirParts) {
  const StreamConfig same = test::SmallConfig();
  EXPECT_TRUE(same == test::SmallConfig());
  for (int part = 0; part < 6; ++part) {
    StreamConfig other = test::SmallConfig();
    if (part == 0) other.coder = other.coder == Coder::kDraco ? Coder::kLidar : Coder::kDraco;
    if (part == 1) other.geometry = Geometry::kXyz;
    if (part == 2) ++other.framerate_n;
    if (part == 3) ++other.framerate_d;
    if (part == 4) other.fields += "x";
    if (part == 5) other.sensor_model.push_back(0);
    EXPECT_FALSE(same == other) << part;
  }
}

TEST(DeliveryLimits, APacketThatIsReportedTwiceCountsOnce) {
  Delivery delivery;
  for (std::uint16_t seq = 0; seq < 3; ++seq) delivery.OnSent({1, seq, {7, 0}, seq == 2});
  EXPECT_TRUE(delivery.OnReceived(1, 1, 1).empty());
  EXPECT_TRUE(delivery.OnReceived(1, 1, 2).empty());
  EXPECT_TRUE(delivery.OnReceived(1, 1, 2).empty());
  EXPECT_EQ(delivery.OnReceived(1, 0, 0).size(), 1U);
}

TEST(UnitCheckLimits, ASliceMayBeAsLongAsTheLimit) {
  for (const std::size_t more : {0U, 1U}) {
    UnitCheck check;
    const auto bytes = test::SliceBytes(1, 0, UnitCheck::kMaxBytes + more);
    bool whole = false;
    std::uint16_t seq = 0;
    for (const Packet& p : Packetize({}, {bytes.data(), bytes.size()}, 60'000)) {
      auto payload = p.header;
      const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(p.body_offset);
      payload.insert(payload.end(), from, from + static_cast<std::ptrdiff_t>(p.body_size));
      whole = check.Push(seq++, {payload.data(), payload.size()}) || whole;
    }
    EXPECT_EQ(whole, more == 0);
  }
}

/// Returns the accounts after a stream of three scans that continues after `pause`. Its scan
/// numbers jump by `scans`.
ReceiverAccounts AfterJump(std::uint32_t scans, Duration pause, bool clock = true) {
  Receiver receiver(test::kReorder);
  test::SenderOptions options;
  options.scan_number = 1'000;
  auto packets = test::Sender(options).Scans(0, 3);
  options.scan_number += scans;
  for (test::Wire& w : test::Sender(options).Scans(3, 3)) {
    w.sent += pause;
    if (!w.config) packets.push_back(w);  // A config alone would end the pause.
  }
  for (test::Wire& w : packets)
    if (!clock) w.sent = {};
  test::DeliverAll(&receiver, packets);
  return receiver.accounts();
}

TEST(ReceiverLimits, AStreamThatWentOnFasterThanAnySensorIsAnother) {
  using std::chrono::seconds;
  EXPECT_EQ(AfterJump(5'000, seconds(0), false).outages, 1U);
  EXPECT_EQ(AfterJump(12'000, seconds(0), false).restarts, 1U);
  EXPECT_EQ(AfterJump(12'000, seconds(10)).outages, 1U);
  EXPECT_EQ(AfterJump(25'000, seconds(10)).restarts, 1U);
}

/// Streams of several senders. Each packet has a whole slice, and a test says when the packet is
/// sent.
class Rivals : public ::testing::Test {
 protected:
  void Push(std::uint32_t ssrc, unsigned packets, int at_ms = 0) {
    auto& sender = senders_.try_emplace(ssrc, OptionsOf(ssrc)).first->second;
    for (unsigned i = 0; i < packets; ++i) {
      std::vector<test::Wire> wire;
      const std::uint32_t n = sent_[ssrc]++;
      sender.Slice(n / 4, static_cast<std::uint16_t>(n % 4), &wire);
      wire.at(0).sent = Time{milliseconds(at_ms)};
      test::Deliver(&receiver, wire.at(0));
    }
  }

  /// Leaves out the next `slices` slices of the stream `ssrc`.
  void Miss(std::uint32_t ssrc, unsigned slices) { sent_[ssrc] += slices; }

  using milliseconds = std::chrono::milliseconds;
  Receiver receiver{test::kReorder};

 private:
  static test::SenderOptions OptionsOf(std::uint32_t ssrc) {
    test::SenderOptions options;
    options.ssrc = ssrc;
    options.slice_size = 300;
    options.scan_number = 1'000;
    return options;
  }
  std::map<std::uint32_t, test::Sender> senders_;
  std::map<std::uint32_t, std::uint32_t> sent_;
};

TEST_F(Rivals, AreToldOfAfterAHundredPackets) {
  Push(1, 1);
  for (std::uint32_t other = 2; other < 2 + Receiver::kMaxRivals; ++other) {
    Push(other, 1);
    Push(1, 1);
  }
  for (unsigned i = 2; i <= Receiver::kRivalPackets; ++i) {
    EXPECT_EQ(receiver.rival(), std::nullopt) << i;
    Push(2, 1);
    Push(1, 1);
  }
  EXPECT_EQ(receiver.rival(), 2U);
  Push(2, 4, 500);  // the first sender is silent
  EXPECT_EQ(receiver.ssrc(), 2U);
  EXPECT_EQ(receiver.rival(), std::nullopt);
}

TEST_F(Rivals, AreNotToldOfWhereThereAreMoreThanAreCounted) {
  Push(1, 1);
  for (unsigned i = 0; i < 2 * Receiver::kRivalPackets; ++i) {
    for (std::uint32_t other = 2; other <= 2 + Receiver::kMaxRivals; ++other) Push(other, 1);
    Push(1, 1);
  }
  EXPECT_EQ(receiver.rival(), std::nullopt) << "their counts begin anew each time";
  EXPECT_EQ(receiver.ssrc(), 1U);
}

TEST_F(Rivals, AreForgottenAtAFlush) {
  for (unsigned i = 0; i <= Receiver::kRivalPackets; ++i) {
    Push(1, 1);
    Push(2, 1);
  }
  EXPECT_EQ(receiver.rival(), 2U);
  receiver.Finish();
  EXPECT_EQ(receiver.rival(), std::nullopt);
  Push(1, 1);
  EXPECT_EQ(receiver.rival(), std::nullopt);
}

TEST_F(Rivals, TakeOverOnceTheStreamWasSilentForTheTimeOfAScan) {
  Push(1, 8, 0);
  Push(2, Receiver::kProbation, 99);
  EXPECT_EQ(receiver.ssrc(), 1U);
  Push(1, 1, 100);
  Push(2, Receiver::kProbation, 200);
  EXPECT_EQ(receiver.ssrc(), 2U);
  // Stream 3 does not take over, because stream 2 was silent only since its own last packet, for 10
  // ms.
  Push(3, Receiver::kProbation, 210);
  EXPECT_EQ(receiver.ssrc(), 2U);
}

TEST_F(Rivals, DoNotTakeOverWhereTheStreamGoesOnBehindAGap) {
  Push(1, 8);
  Push(2, Receiver::kProbation - 1);
  Miss(1, 20);
  Push(1, 1);
  EXPECT_EQ(receiver.ssrc(), 1U);
  Push(1, Receiver::kProbation - 1);
  EXPECT_EQ(receiver.ssrc(), 1U);
  EXPECT_EQ(receiver.accounts().outages, 1U);
  EXPECT_EQ(receiver.accounts().restarts, 0U);
}

TEST_F(Rivals, ThatGiveUpLeaveTheirPacketsAsInvalid) {
  Push(1, 4);
  Push(2, 2);
  Push(3, 1);
  EXPECT_EQ(receiver.accounts().packets.invalid, 2U);
  Push(2, 1);
  EXPECT_EQ(receiver.accounts().packets.invalid, 3U);
}

class LedgerLimits : public ::testing::Test {
 protected:
  static void Receive(SliceLedger* ledger, std::int64_t scan, std::uint32_t index,
                      std::uint32_t count) {
    ASSERT_EQ(ledger->Admit({scan, index}, count, Time{}), Admission::kOpen);
    ledger->Settle({scan, index}, SliceOutcome::kReceived);
  }

  SliceLedger before{test::kReorder};
  SliceLedger after{test::kReorder};
};

TEST_F(LedgerLimits, AJumpMayBeOf64Scans) {
  Receive(&before, 1, 0, 4);
  EXPECT_EQ(before.Admit({66, 0}, 4, Time{}), Admission::kContradiction);
  EXPECT_EQ(before.Admit({65, 0}, 4, Time{}), Admission::kOpen);
}

TEST_F(LedgerLimits, ALossIsTakenBackOf64ScansBefore) {
  for (std::int64_t scan = 1; scan <= 60; ++scan)
    if (scan != 2) Receive(&before, scan, 0, 1);
  before.CloseBefore({60, 0});
  EXPECT_EQ(before.accounts().slices_lost, 1U);
  before.Skip({2, 0});
  EXPECT_EQ(before.accounts().slices_lost, 0U);
  EXPECT_EQ(before.accounts().slices_skipped, 1U);
}

TEST_F(LedgerLimits, AnEndIsBookedOnce) {
  Receive(&before, 1, 0, 4);
  before.Finish();
  before.Finish();
  EXPECT_EQ(before.accounts().scans_incomplete, 1U);
}

TEST_F(LedgerLimits, AnOutageWithinAScanCostsWhatIsBetween) {
  Receive(&before, 1, 0, 4);
  before.Finish();
  Receive(&after, 1, 3, 4);
  after.Continue(before);
  EXPECT_EQ(after.accounts().slices_lost, 2U);
  EXPECT_EQ(after.accounts().slices_received, 2U);
}

TEST_F(LedgerLimits, AfterAnOutage64SlicesBeforeItsBeginMayTurnOutToBeSkipped) {
  Receive(&before, 0, 0, 100);
  Receive(&before, 0, 99, 100);
  before.Finish();
  Receive(&after, 1, 0, 100);
  after.Continue(before);
  EXPECT_EQ(after.accounts().slices_lost, 98U);
  after.Skip({0, 34});
  EXPECT_EQ(after.accounts().slices_lost, 98U);
  after.Skip({0, 35});
  EXPECT_EQ(after.accounts().slices_lost, 97U);
  EXPECT_EQ(after.accounts().slices_skipped, 1U);
}

/// Returns a slice that has one packet and refers to the config `config_id`.
test::Wire OnePacket(std::uint16_t index, std::uint8_t config_id, int at_ms) {
  test::SenderOptions options;
  options.slice_size = 300;
  options.config_id = config_id;
  std::vector<test::Wire> wire;
  test::Sender(options).Slice(0, index, &wire);
  wire.at(0).sent = Time{std::chrono::milliseconds(at_ms)};
  return wire.at(0);
}

void TellConfig(Receiver* receiver, std::uint8_t id) {
  test::SenderOptions options;
  options.config_id = id;
  std::vector<test::Wire> wire;
  test::Sender(options).Config(&wire);
  for (const test::Wire& w : wire) test::Deliver(receiver, w);
}

TEST(ReassemblerLimits, FourConfigsAreKept) {
  Receiver receiver(test::kReorder);
  for (std::uint8_t id = 1; id <= 4; ++id) TellConfig(&receiver, id);
  EXPECT_EQ(test::Deliver(&receiver, OnePacket(0, 1, 0)).size(), 1U);
  TellConfig(&receiver, 5);
  EXPECT_TRUE(test::Deliver(&receiver, OnePacket(1, 1, 0)).empty());
  EXPECT_EQ(test::Deliver(&receiver, OnePacket(2, 2, 0)).size(), 1U);
}

TEST(ReassemblerLimits, ASliceWithoutItsConfigIsAGap) {
  Receiver receiver(test::kReorder);
  TellConfig(&receiver, 9);
  EXPECT_TRUE(test::Deliver(&receiver, OnePacket(0, 9, 0)).at(0).discont);
  EXPECT_TRUE(test::Deliver(&receiver, OnePacket(1, 10, 1)).empty());
  EXPECT_FALSE(test::Deliver(&receiver, OnePacket(2, 9, 2)).at(0).discont);
  EXPECT_TRUE(test::Deliver(&receiver, OnePacket(3, 9, 200)).at(0).discont);
  EXPECT_EQ(receiver.accounts().slices.slices_config_mismatch, 1U);
}

TEST(ReassemblerLimits, ASliceHasTheTimeOfItsFirstPacketOrItsOwnInAnAggregate) {
  using std::chrono::milliseconds;
  Receiver receiver(test::kReorder);
  TellConfig(&receiver, 9);
  std::vector<test::Wire> wire;
  test::Sender().Slice(0, 0, &wire);
  for (std::size_t i = 0; i < wire.size(); ++i) {
    wire[i].sent = Time{milliseconds(20 + 5 * i)};
    for (const ReceivedSlice& slice : test::Deliver(&receiver, wire[i]))
      EXPECT_EQ(slice.pts, Time{milliseconds(20)});
  }
  Aggregator aggregator;
  const auto bytes = test::SliceBytes(0, 1, 50);
  for (const std::uint16_t index : {std::uint16_t{1}, std::uint16_t{2}}) {
    Unit unit;
    unit.config_id = 9;
    unit.slice = {test::SenderOptions{}.scan_number, index, 4};
    ASSERT_TRUE(aggregator.Add(unit, {bytes.data(), bytes.size()}, 1'000, index * 900U));
  }
  test::Wire aggregate = wire.back();
  aggregate.payload = aggregator.Take()->header;
  const auto slices = test::Deliver(&receiver, aggregate);
  ASSERT_EQ(slices.size(), 2U);
  EXPECT_EQ(slices[0].pts, aggregate.sent);
  EXPECT_EQ(slices[1].pts, aggregate.sent + milliseconds(10));  // 900 ticks of 90 kHz
}

}  // namespace
}  // namespace lidar::rtp
