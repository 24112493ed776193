// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/bonding/scheduler.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "src/link/random.h"
#include "src/sim/simulated_time.h"

namespace lidar::bonding {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kMedia = 9;
constexpr DataSize kSize = DataSize::Bytes(1200);

LinkSet SetOf(std::initializer_list<std::size_t> links) {
  LinkSet set;
  for (const std::size_t link : links) set.set(link);
  return set;
}

rtcp::CongestionFeedback Arrived(std::uint16_t seq) {
  rtcp::CongestionFeedback feedback;
  feedback.blocks.push_back({kMedia, seq, {{true, Ecn::kEct1, std::nullopt}}});
  return feedback;
}

/// Two links of 8 Mbit/s with a round trip of 40 ms. Each packet is a slice.
class TwoLinks : public testing::Test {
 protected:
  TwoLinks() { SetPaths({Mbps(8), 40ms}, {Mbps(8), 40ms}); }

  void SetPaths(const PathView& a, const PathView& b) {
    scheduler_.OnPath(0, a);
    scheduler_.OnPath(1, b);
  }

  /// Passes a packet to the scheduler. Each link that the scheduler chose sends it at once. Returns
  /// these links.
  LinkSet Packet() {
    const PacketId id{kMedia, ++seq_};
    const LinkSet links = scheduler_.OnPacket(now_, {id, kSize, seq_});
    for (std::size_t i = 0; i < 2; ++i)
      if (links[i]) scheduler_.OnSent(now_, i, id);
    return links;
  }

  /// Sends packets for `time`, one per `period`. Both links deliver and report them without delay.
  void Work(Duration time, Duration period = 12500us) {
    for (const Time end = now_ + time; now_ < end; now_ += period) {
      const LinkSet links = Packet();
      for (std::size_t i = 0; i < 2; ++i)
        if (links[i]) scheduler_.OnFeedback(now_, i, Arrived(seq_));
    }
  }

  /// Sends packets until the links are settled and a packet was just copied. The next slice is then
  /// sent without a copy.
  void Settle() {
    Work(4s);
    LinkSet links;
    do {
      links = Packet();
      for (std::size_t i = 0; i < 2; ++i)
        if (links[i]) scheduler_.OnFeedback(now_, i, Arrived(seq_));
    } while (links.count() < 2);
  }

  Scheduler scheduler_{2, Method::kAdaptive};
  Time now_ = kStart;
  std::uint16_t seq_ = 0;
};

TEST_F(TwoLinks, CopiesAllWhileLinksAreNewAndOneOfEightLater) {
  EXPECT_EQ(Packet(), SetOf({0, 1}));
  Work(4s);
  int copies = 0;
  for (int i = 0; i < 80; ++i) {
    const LinkSet links = Packet();
    EXPECT_TRUE(links[0]);
    copies += links[1];
    for (std::size_t k = 0; k < 2; ++k)
      if (links[k]) scheduler_.OnFeedback(now_, k, Arrived(seq_));
    now_ += 12500us;
  }
  EXPECT_EQ(copies, 10);
}

TEST_F(TwoLinks, SendsASliceWhereItIsWholeFirst) {
  Settle();
  SetPaths({Mbps(8), 40ms}, {Mbps(8), 20ms});
  EXPECT_EQ(Packet(), SetOf({1})) << "by 10 ms sooner";
  // A backlog in the FIFO of the link with the shorter round trip makes this link deliver later.
  const std::uint32_t slice = ++seq_;
  for (int i = 0; i < 30; ++i) scheduler_.OnPacket(now_, {{kMedia, ++seq_}, kSize, slice});
  EXPECT_EQ(Packet(), SetOf({0}));
}

TEST_F(TwoLinks, ExpectsASliceAsLargeAsTheOneBefore) {
  Settle();
  SetPaths({Mbps(8), 20ms}, {Mbps(16), 60ms});
  EXPECT_TRUE(Packet()[0]) << "1.2 ms and 10 ms";
  const std::uint32_t slice = ++seq_;
  for (int i = 0; i < 70; ++i) {
    const PacketId id{kMedia, ++seq_};
    const LinkSet links = scheduler_.OnPacket(now_, {id, kSize, slice});
    for (std::size_t link = 0; link < 2; ++link)
      if (links[link]) scheduler_.OnSent(now_, link, id);
  }
  EXPECT_EQ(Packet(), SetOf({1})) << "42 ms and 30 ms, not 84 ms and 10 ms";
  EXPECT_EQ(Packet(), SetOf({0})) << "one packet";
}

TEST_F(TwoLinks, APacketThatTheSourceSendsAgainIsBookedOnce) {
  Settle();
  const std::uint64_t before = scheduler_.counters(0).packets;
  const PacketId id{kMedia, ++seq_};
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(scheduler_.OnPacket(now_, {id, kSize, seq_}), SetOf({0}));
    scheduler_.OnSent(now_, 0, id);
  }
  EXPECT_EQ(scheduler_.counters(0).packets, before + 1);
  EXPECT_EQ(Packet(), SetOf({0})) << "no packet waits in its FIFO";
}

TEST_F(TwoLinks, AnAbandonedSourceLeavesNothingInTheFifos) {
  Settle();
  const PacketId other{kMedia + 1, 0};
  scheduler_.OnPacket(now_, {other, kSize, 0});
  const std::uint32_t slice = ++seq_;
  for (int i = 0; i < 30; ++i) scheduler_.OnPacket(now_, {{kMedia, ++seq_}, kSize, slice});
  scheduler_.Abandon(kMedia);
  EXPECT_EQ(Packet(), SetOf({0})) << "which has no backlog";
  scheduler_.Abandon(kMedia);
  const auto copies = scheduler_.TakeCopies(now_ + 150ms);
  ASSERT_EQ(copies.size(), 1U);
  EXPECT_EQ(copies[0].id, other);
}

TEST_F(TwoLinks, CopiesAtOnceWhatWaitsBehindAGap) {
  Settle();
  Packet();
  const std::uint16_t waits = seq_;
  EXPECT_TRUE(scheduler_.TakeCopies(now_ + 40ms).empty());
  const auto copies = scheduler_.TakeCopies(now_ + 61ms);
  ASSERT_EQ(copies.size(), 1U);
  EXPECT_EQ(copies[0].id.seq, waits);
  EXPECT_EQ(copies[0].link, 1U);
  EXPECT_TRUE(scheduler_.InGap(now_ + 61ms, 0));
  EXPECT_TRUE(scheduler_.TakeCopies(now_ + 62ms).empty()) << "once";
}

TEST_F(TwoLinks, CopiesWhatWaitsInAFifoForLongerThanExpected) {
  Settle();
  const PacketId id{kMedia, ++seq_};
  ASSERT_EQ(scheduler_.OnPacket(now_, {id, kSize, seq_}), SetOf({0}));
  // A copy is due after 61.2 ms: 1.2 ms for sending, a round trip, and 20 ms.
  EXPECT_TRUE(scheduler_.TakeCopies(now_ + 61ms).empty());
  EXPECT_FALSE(scheduler_.InGap(now_ + 62ms, 0)) << "nothing was sent that could be reported";
  const auto copies = scheduler_.TakeCopies(now_ + 62ms);
  ASSERT_EQ(copies.size(), 1U);
  EXPECT_EQ(copies[0].link, 1U);
}

TEST_F(TwoLinks, CopiesTheOldestFirst) {
  Settle();
  const std::uint32_t slice = ++seq_;
  for (int i = 0; i < 3; ++i) {
    const PacketId id{kMedia, ++seq_};
    scheduler_.OnPacket(now_, {id, kSize, slice});
    scheduler_.OnSent(now_, 0, id);
  }
  const auto copies = scheduler_.TakeCopies(now_ + 61ms);
  ASSERT_EQ(copies.size(), 3U);
  for (std::uint16_t i = 0; i < 3; ++i) EXPECT_EQ(copies[i].id.seq, seq_ - 2 + i);
}

TEST_F(TwoLinks, CopiesNothingThatIsTooOld) {
  Settle();
  Packet();
  EXPECT_TRUE(scheduler_.TakeCopies(now_ + Scheduler::kMaxAge + 1ms).empty());
}

TEST_F(TwoLinks, ForgetsWhatWaitsForALinkInTheEnd) {
  Settle();
  SetPaths({Mbps(8), 40ms}, {Mbps(8), 20ms});
  const std::uint32_t slice = ++seq_;
  for (int i = 0; i < 30; ++i) scheduler_.OnPacket(now_, {{kMedia, ++seq_}, kSize, slice});
  EXPECT_FALSE(Packet()[1]);
  scheduler_.OnFeedback(now_, 0, Arrived(seq_));
  now_ += 3s;
  EXPECT_TRUE(Packet()[1]);
}

TEST_F(TwoLinks, LeavesALinkInAGapAndComesBackWithItsFirstReport) {
  Settle();
  Packet();
  const std::uint16_t waits = seq_;
  now_ += 61ms;
  EXPECT_EQ(Packet(), SetOf({1}));
  scheduler_.OnFeedback(now_, 1, Arrived(seq_));
  scheduler_.OnFeedback(now_, 0, Arrived(waits));
  EXPECT_FALSE(scheduler_.InGap(now_, 0));
  EXPECT_EQ(Packet(), SetOf({0, 1})) << "not settled again";
}

TEST_F(TwoLinks, CopiesWhatWasLost) {
  Settle();
  Packet();
  const std::uint16_t lost = seq_;
  Packet();
  scheduler_.OnFeedback(now_, 0, Arrived(seq_));
  const auto copies = scheduler_.TakeCopies(now_);
  ASSERT_EQ(copies.size(), 1U);
  EXPECT_EQ(copies[0].id.seq, lost);
}

TEST(ThreeLinks, GetOneCopyOfWhatWasLostUntilThatIsOverdue) {
  Scheduler scheduler(3, Method::kBackup);
  for (std::size_t i = 0; i < 3; ++i) scheduler.OnPath(i, {Mbps(8), 40ms});
  std::uint16_t seq = 0;
  const auto send = [&] {
    const PacketId id{kMedia, ++seq};
    const LinkSet links = scheduler.OnPacket(kStart, {id, kSize, seq, true});
    for (std::size_t i = 0; i < 3; ++i)
      if (links[i]) scheduler.OnSent(kStart, i, id);
    return links;
  };
  const auto arrives = [&](LinkSet links) {
    for (std::size_t i = 0; i < 3; ++i)
      if (links[i]) scheduler.OnFeedback(kStart, i, Arrived(seq));
    return links.count();
  };
  while (arrives(send()) > 1) ASSERT_LT(seq, 100);
  const LinkSet first = send();
  const std::uint16_t lost = seq;
  ASSERT_EQ(first.count(), 1U);
  ASSERT_EQ(send(), first);
  arrives(first);
  const auto copies = scheduler.TakeCopies(kStart);
  ASSERT_EQ(copies.size(), 1U);
  EXPECT_EQ(copies[0].id.seq, lost);
  EXPECT_FALSE(first[copies[0].link]);
  EXPECT_TRUE(scheduler.TakeCopies(kStart + 39ms).empty()) << "the copy may still arrive";
  EXPECT_EQ(scheduler.TakeCopies(kStart + 100ms).size(), 1U) << "on the third link";
}

/// If each link is in a gap, nobody knows which link will deliver first.
TEST(ThreeLinks, AllGetACopyOfWhatWaitsWhereEachIsInAGap) {
  for (const bool in_gap : {false, true}) {
    Scheduler scheduler(3, Method::kBackup);
    for (std::size_t i = 0; i < 3; ++i) scheduler.OnPath(i, {Mbps(8), 40ms});
    Time now = kStart;
    std::uint16_t seq = 0;
    const auto send = [&](bool arrives) {
      const PacketId id{kMedia, ++seq};
      const LinkSet links = scheduler.OnPacket(now, {id, kSize, seq, true});
      for (std::size_t i = 0; i < 3; ++i) {
        if (!links[i]) continue;
        scheduler.OnSent(now, i, id);
        if (arrives) scheduler.OnFeedback(now, i, Arrived(seq));
      }
      return links;
    };
    while (send(true).count() > 1) ASSERT_LT(seq, 100);
    const LinkSet first = send(false);
    ASSERT_EQ(first.count(), 1U);
    const PacketId waits{kMedia, seq};
    // The other links have a packet without a report, too. So each link is in a gap.
    for (std::size_t i = 0; i < 3 && in_gap; ++i)
      if (!first[i]) scheduler.OnSent(now, i, {kMedia + 1, static_cast<std::uint16_t>(i)});
    now += 61ms;
    std::size_t copies = 0;
    for (const Scheduler::Copy& copy : scheduler.TakeCopies(now)) copies += copy.id == waits;
    EXPECT_EQ(copies, in_gap ? 2U : 1U);
  }
}

TEST_F(TwoLinks, SendsNothingThatArrivedOnTheOtherLink) {
  const PacketId id{kMedia, 1};
  ASSERT_EQ(scheduler_.OnPacket(now_, {id, kSize, 1}), SetOf({0, 1}));
  EXPECT_TRUE(scheduler_.Wants(now_, 0, id));
  scheduler_.OnSent(now_, 1, id);
  scheduler_.OnFeedback(now_, 1, Arrived(1));
  EXPECT_FALSE(scheduler_.Wants(now_, 0, id));
  EXPECT_TRUE(scheduler_.OnDropped(now_, 0, id));
  EXPECT_EQ(scheduler_.counters(0).cancelled, 1U);
  EXPECT_EQ(scheduler_.counters(1).saved, 1U);
}

TEST_F(TwoLinks, CountsNoCopyAsCancelledThatIsLate) {
  const PacketId id{kMedia, 1};
  ASSERT_EQ(scheduler_.OnPacket(now_, {id, kSize, 1}), SetOf({0, 1}));
  EXPECT_FALSE(scheduler_.OnDropped(now_ + 300ms, 0, id));
  EXPECT_FALSE(scheduler_.OnDropped(now_ + 300ms, 0, id)) << "again";
  EXPECT_EQ(scheduler_.counters(0).cancelled, 0U);
}

TEST_F(TwoLinks, CopiesToEachLinkWhatWaitsWhileAllAreInGaps) {
  Settle();
  now_ += 1ms;
  SetPaths({Mbps(8), 40ms}, {Mbps(8), 20ms});
  ASSERT_EQ(Packet(), SetOf({1}));
  SetPaths({Mbps(8), 20ms}, {Mbps(8), 40ms});
  ASSERT_EQ(Packet(), SetOf({0}));
  now_ += 61ms;
  ASSERT_TRUE(scheduler_.InGap(now_, 0) && scheduler_.InGap(now_, 1));
  const auto copies = scheduler_.TakeCopies(now_);
  ASSERT_EQ(copies.size(), 2U);
  EXPECT_EQ(copies[0].link, 0U);
  EXPECT_EQ(copies[1].link, 1U);
}

TEST_F(TwoLinks, DropsWhatIsLateOnEachLinkThatHasIt) {
  const PacketId id{kMedia, 1};
  ASSERT_EQ(scheduler_.OnPacket(now_, {id, kSize, 1}).count(), 2U);
  for (const std::size_t link : {0U, 1U}) {
    EXPECT_TRUE(scheduler_.Wants(now_ + 200ms, link, id));
    EXPECT_FALSE(scheduler_.Wants(now_ + 201ms, link, id));
  }
}

TEST_F(TwoLinks, DropsWhatWouldArriveLate) {
  SetPaths({Mbps(8), 300ms, 40ms}, {Mbps(8), 600ms, 500ms});
  const PacketId id{kMedia, 1};
  ASSERT_EQ(scheduler_.OnPacket(now_, {id, kSize, 1}).count(), 2U);
  EXPECT_TRUE(scheduler_.Wants(now_ + 180ms, 0, id));
  EXPECT_FALSE(scheduler_.Wants(now_ + 181ms, 0, id));
  EXPECT_TRUE(scheduler_.Wants(now_ + 100ms, 1, id)) << "a far link is known by such copies";
  EXPECT_FALSE(scheduler_.Wants(now_ + 101ms, 1, id));
}

TEST_F(TwoLinks, LeavesLatePacketsOfOneLinkToItsCongestionControl) {
  Settle();
  const PacketId id{kMedia, ++seq_};
  ASSERT_EQ(scheduler_.OnPacket(now_, {id, kSize, seq_}), SetOf({0}));
  EXPECT_TRUE(scheduler_.Wants(now_ + 201ms, 0, id));
}

TEST_F(TwoLinks, AsksForWhatTheBetterOneCarriesUntilThatIsDead) {
  const std::vector<DataRate> targets{Mbps(10), Mbps(3)};
  Settle();
  EXPECT_EQ(scheduler_.Target(now_, targets), Mbps(10));
  Packet();
  scheduler_.OnFeedback(now_, 1, Arrived(seq_));
  EXPECT_EQ(scheduler_.Target(now_ + 100ms, targets), Mbps(10));
  EXPECT_EQ(scheduler_.Target(now_ + 150ms, targets), Mbps(3));
  scheduler_.SetUsable(now_, 0, false);
  EXPECT_EQ(scheduler_.Target(now_, targets), Mbps(3));
  scheduler_.SetUsable(now_, 1, false);
  EXPECT_EQ(scheduler_.Target(now_, targets), Mbps(10)) << "nothing is known";
}

TEST_F(TwoLinks, AsksForNoMoreThanTheNearOneCarriesWhereTheOtherIsFar) {
  SetPaths({Mbps(8), 20ms}, {Mbps(10), 150ms});
  EXPECT_EQ(scheduler_.Target(now_, {Mbps(8), Mbps(10)}), Mbps(8));
}

TEST_F(TwoLinks, RefusesForgedReports) {
  Packet();
  EXPECT_FALSE(scheduler_.OnFeedback(now_, 0, Arrived(77)));
  EXPECT_TRUE(scheduler_.InGap(now_ + 1s, 0));
}

TEST_F(TwoLinks, RefusesReportsOfTheOtherLinkAndLosesNothing) {
  Settle();
  ASSERT_EQ(Packet(), SetOf({0}));
  EXPECT_FALSE(scheduler_.OnFeedback(now_, 1, Arrived(seq_))) << "swapped";
  EXPECT_EQ(scheduler_.OwnerOf(Arrived(seq_)), std::size_t{0});
  EXPECT_FALSE(scheduler_.OwnerOf(Arrived(static_cast<std::uint16_t>(seq_ + 1)))) << "forged";
  rtcp::CongestionFeedback report = Arrived(seq_);
  report.blocks.push_back({kMedia + 1, 1, {{true, Ecn::kEct1, std::nullopt}}});
  EXPECT_FALSE(scheduler_.OwnerOf(report)) << "with a block of another's packets";
  const auto copies = scheduler_.TakeCopies(now_ + 61ms);
  ASSERT_EQ(copies.size(), 1U);
  scheduler_.OnSent(now_ + 61ms, 1, copies[0].id);
  EXPECT_TRUE(scheduler_.OnFeedback(now_ + 100ms, 1, Arrived(seq_)));
  EXPECT_FALSE(scheduler_.Wants(now_ + 100ms, 0, copies[0].id));
  EXPECT_EQ(scheduler_.counters(1).saved, 1U);
}

TEST_F(TwoLinks, SendsNothingByALinkThatCannotBeUsed) {
  Settle();
  scheduler_.SetUsable(now_, 0, false);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(Packet(), SetOf({1}));
}

TEST_F(TwoLinks, GivesALinkThatCameBackCopiesOnlyUntilItsFirstReport) {
  Settle();
  scheduler_.SetUsable(now_, 0, false);
  for (int i = 0; i < 20; ++i) {
    Packet();
    scheduler_.OnFeedback(now_, 1, Arrived(seq_));
  }
  scheduler_.SetUsable(now_, 0, true);
  SetPaths({Mbps(80), 20ms}, {Mbps(8), 40ms});
  const std::uint64_t own = scheduler_.counters(0).packets;
  for (int i = 0; i < 20; ++i) EXPECT_EQ(Packet(), SetOf({0, 1}));
  EXPECT_EQ(scheduler_.counters(0).packets, own);
  scheduler_.OnFeedback(now_, 0, Arrived(seq_));
  Packet();
  EXPECT_GT(scheduler_.counters(0).packets, own) << "it is the better one";
}

TEST_F(TwoLinks, ForgetsAllAtARestartButWhichLinksCanBeUsed) {
  Work(4s);
  scheduler_.SetUsable(now_, 1, false);
  Packet();
  scheduler_.Restart();
  EXPECT_FALSE(scheduler_.AwaitsArrivals(now_));
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(scheduler_.usable(i), i == 0);
    EXPECT_FALSE(scheduler_.has_reported(i));
    const LinkCounters& c = scheduler_.counters(i);
    EXPECT_EQ(c.packets + c.copies + c.cancelled + c.saved + c.gaps, 0U) << i;
  }
  EXPECT_EQ(Packet(), SetOf({0}));
}

TEST(Scheduler, SumsUpTargetsOfLinksThatWork) {
  Scheduler scheduler(2, Method::kAdaptive, TargetRule::kSum);
  EXPECT_EQ(scheduler.Target(kStart, {Mbps(10), Mbps(3)}), Mbps(13));
  scheduler.SetUsable(kStart, 0, false);
  EXPECT_EQ(scheduler.Target(kStart, {Mbps(10), Mbps(3)}), Mbps(3));
  scheduler.SetUsable(kStart, 1, false);
  EXPECT_EQ(scheduler.Target(kStart, {Mbps(10), Mbps(3)}), Mbps(10)) << "not a sum of dead links";
}

TEST(Scheduler, ProvesALinkThatCameBackForASecondWithCopiesOfAllPackets) {
  Scheduler scheduler(2, Method::kBackup);
  for (std::size_t i = 0; i < 2; ++i) scheduler.OnPath(i, {Mbps(8), 40ms});
  Time now = kStart;
  std::uint16_t seq = 0;
  const auto send = [&](bool second_reports) {
    const PacketId id{kMedia, ++seq};
    const LinkSet links = scheduler.OnPacket(now, {id, kSize, seq});
    for (std::size_t i = 0; i < 2; ++i) {
      if (!links[i]) continue;
      scheduler.OnSent(now, i, id);
      if (i == 0 || second_reports) scheduler.OnFeedback(now, i, Arrived(seq));
    }
    now += 12500us;
    return links;
  };
  for (int i = 0; i < 200; ++i) send(true);
  scheduler.SetUsable(now, 1, false);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(send(false), SetOf({0}));
  scheduler.SetUsable(now, 1, true);
  for (int i = 0; i < 80; ++i) EXPECT_EQ(send(false), SetOf({0, 1})) << i;
  int copies = 0;
  for (int i = 0; i < 80; ++i) copies += send(false)[1];
  EXPECT_EQ(copies, 10) << "one of eight";
}

TEST(Scheduler, BroadcastsEveryPacketAndBacksUpOnlyWhatWaits) {
  Scheduler broadcast(3, Method::kBroadcast), backup(3, Method::kBackup);
  for (std::uint16_t seq = 1; seq < 8; ++seq) {
    EXPECT_EQ(broadcast.OnPacket(kStart, {{kMedia, seq}, kSize, seq}), SetOf({0, 1, 2}));
    const Time now = seq == 1 ? kStart : kStart + 2s;  // At first, all links are used.
    const LinkSet links = backup.OnPacket(now, {{kMedia, seq}, kSize, seq});
    EXPECT_EQ(links.count(), seq == 1 ? 3U : 1U) << "the first of eight keeps links known";
  }
}

TEST(Scheduler, SendsAllOnEachLinkUntilTheReceiverKnowsThem) {
  Scheduler scheduler(2, Method::kAdaptive);
  std::uint16_t seq = 0;
  for (; seq < 40; ++seq)  // more than links of an unknown rate have room for
    EXPECT_EQ(scheduler.OnPacket(kStart, {{kMedia, seq}, kSize, seq}), SetOf({0, 1}));
  scheduler.OnSent(kStart, 0, {kMedia, 1});
  scheduler.OnFeedback(kStart, 0, Arrived(1));
  EXPECT_EQ(scheduler.OnPacket(kStart, {{kMedia, seq}, kSize, seq}), SetOf({0, 1}));
  scheduler.OnSent(kStart, 1, {kMedia, 1});
  scheduler.OnFeedback(kStart, 1, Arrived(1));
  int alone = 0;
  while (++seq < 60) alone += scheduler.OnPacket(kStart, {{kMedia, seq}, kSize, seq}).count() == 1;
  EXPECT_GT(alone, 10) << "there is no room for copies";
}

TEST(Scheduler, AwaitsArrivalsWhileTheyAreOfUse) {
  Scheduler scheduler(2, Method::kAdaptive);
  EXPECT_FALSE(scheduler.AwaitsArrivals(kStart));
  scheduler.OnPacket(kStart, {{kMedia, 1}, kSize, 1});
  EXPECT_TRUE(scheduler.AwaitsArrivals(kStart + 200ms));
  EXPECT_FALSE(scheduler.AwaitsArrivals(kStart + 201ms));
  scheduler.OnSent(kStart, 1, {kMedia, 1});
  scheduler.OnFeedback(kStart, 1, Arrived(1));
  EXPECT_FALSE(scheduler.AwaitsArrivals(kStart));
}

TEST(Scheduler, KeepsAllPacketsOfASliceTogether) {
  Scheduler scheduler(2, Method::kBackup);
  scheduler.OnPacket(kStart, {{kMedia, 1}, kSize, 1});
  const LinkSet first = scheduler.OnPacket(kStart, {{kMedia, 2}, kSize, 2});
  for (std::uint16_t seq = 3; seq < 90; ++seq)
    EXPECT_EQ(scheduler.OnPacket(kStart, {{kMedia, seq}, kSize, 2}), first);
}

/// Links whose packets pass through FIFOs of 8 Mbit/s. Several links may share a FIFO.
class LinksOfFifos {
 public:
  LinksOfFifos(std::vector<std::size_t> fifo_of_link, Method method,
               TargetRule rule = TargetRule::kBetter)
      : scheduler_(fifo_of_link.size(), method, rule),
        fifo_of_link_(std::move(fifo_of_link)),
        free_(fifo_of_link_.size(), kStart) {}

  void Send(std::size_t link, PacketId id, DataSize size) {
    now_ += 10us;
    scheduler_.OnSent(now_, link, id);
    Time& leaves = free_[fifo_of_link_[link]];
    leaves = std::max(leaves, now_) + size / Mbps(8);
    rtcp::CongestionFeedback report = Arrived(id.seq);
    report.report_timestamp = static_cast<std::uint32_t>(Seconds(leaves - kStart) * 65536);
    report.blocks[0].metrics[0].arrival_offset = 0ms;
    scheduler_.OnFeedback(now_, link, report);
  }
  /// Sends bursts of packets, which show the scheduler which links share a FIFO.
  void Burst() {
    for (int i = 0; i < 6000; ++i) {
      now_ += i % 20 == 0 ? 40ms : FromSeconds(0.0005 + 0.001 * random_.Uniform());
      const auto size = DataSize::Bytes(random_.Chance(0.5) ? 1200 : 600);
      const PacketId id{kMedia, ++seq_};
      scheduler_.OnPacket(now_, {id, size, seq_});
      for (std::size_t link = 0; link < fifo_of_link_.size(); ++link)
        if (random_.Chance(0.6)) Send(link, id, size);
    }
  }
  std::vector<std::size_t> Bottlenecks() const {
    std::vector<std::size_t> bottlenecks;
    for (std::size_t link = 0; link < fifo_of_link_.size(); ++link)
      bottlenecks.push_back(scheduler_.Bottleneck(link));
    return bottlenecks;
  }

  Scheduler scheduler_;
  Time now_ = kStart;
  std::uint16_t seq_ = 0;

 private:
  const std::vector<std::size_t> fifo_of_link_;
  std::vector<Time> free_;
  link::Random random_{3};
};

TEST(Scheduler, TellsWhichLinksPassOneQueue) {
  using Links = std::vector<std::size_t>;
  for (const auto& [fifos, expected] :
       {std::pair(Links{0, 1}, Links{0, 1}), std::pair(Links{0, 0}, Links{0, 0}),
        std::pair(Links{0, 1, 1}, Links{0, 1, 1}), std::pair(Links{0, 1, 0}, Links{0, 1, 0})}) {
    LinksOfFifos links(fifos, Method::kBroadcast, TargetRule::kSum);
    links.Burst();
    EXPECT_EQ(links.Bottlenecks(), expected);
    const auto queues = static_cast<double>(std::set(expected.begin(), expected.end()).size());
    EXPECT_EQ(links.scheduler_.Target(links.now_, std::vector(4, Mbps(1))), queues * Mbps(1));
  }
}

TEST(Scheduler, ForgetsTheBottleneckOfALinkThatGoesOrComesBack) {
  for (const std::size_t link : {0U, 1U}) {
    LinksOfFifos links({0, 0}, Method::kBroadcast);
    links.Burst();
    links.scheduler_.SetUsable(links.now_, link, true);
    EXPECT_EQ(links.scheduler_.Bottleneck(1), 0U) << "no change";
    links.scheduler_.SetUsable(links.now_, link, false);
    EXPECT_EQ(links.scheduler_.Bottleneck(1), 1U) << "it may come back by another path";
  }
}

TEST(Scheduler, KeepsALinkThatIsSparedKnownByOnePacketInThirtyTwoSlices) {
  LinksOfFifos links({0, 0}, Method::kAdaptive);
  links.Burst();
  ASSERT_EQ(links.scheduler_.Bottleneck(1), 0U);
  int first = 0, spared = 0;
  for (std::uint32_t slice = 0; slice < 320; ++slice) {
    for (const bool ends : {false, true}) {
      links.now_ += 5ms;
      const PacketId id{kMedia, ++links.seq_};
      const LinkSet to = links.scheduler_.OnPacket(links.now_, {id, kSize, 100'000 + slice, ends});
      for (std::size_t i = 0; i < 2; ++i)
        if (to[i]) links.Send(i, id, kSize);
      EXPECT_TRUE(!to[1] || ends) << "the end of a slice is reported at once";
      first += to[0];
      spared += to[1];
    }
  }
  EXPECT_EQ(first, 640);
  EXPECT_EQ(spared, 10);
}

TEST(Scheduler, SparesNoLinkBesideOneThatIsDead) {
  LinksOfFifos links({0, 0}, Method::kAdaptive);
  links.Burst();
  ASSERT_EQ(links.scheduler_.Bottleneck(1), 0U);
  links.now_ += 1s;
  const Time silent_since = links.now_;
  for (std::uint32_t slice = 0; links.now_ < silent_since + 1s; ++slice, links.now_ += 5ms) {
    const PacketId id{kMedia, ++links.seq_};
    const LinkSet to = links.scheduler_.OnPacket(links.now_, {id, kSize, 100'000 + slice, false});
    links.scheduler_.OnSent(links.now_, 0, id);  // This packet is not reported.
    const Duration silent = links.now_ - silent_since;
    EXPECT_TRUE(to[1] || silent < 300ms) << Seconds(silent);
    EXPECT_FALSE(to[1] && silent < 100ms) << Seconds(silent);
  }
}

TEST(Scheduler, KeepsBoundedMemory) {
  Scheduler scheduler(4, Method::kBroadcast);
  for (int i = 0; i < 300000; ++i)
    scheduler.OnPacket(
        kStart, {{kMedia, static_cast<std::uint16_t>(i)}, kSize, static_cast<std::uint32_t>(i)});
  EXPECT_LE(scheduler.TakeCopies(kStart + 150ms).size(), 4 * Scheduler::kMaxPackets);
  EXPECT_TRUE(scheduler.TakeCopies(kStart + 10s).empty());
}

}  // namespace
}  // namespace lidar::bonding
