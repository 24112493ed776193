// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of a peer with several links: which address becomes a link, which links get reports, and
// which packets count as copies.
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "gst/scream/bond/link_stats.h"
#include "gst/scream/peer_latch.h"
#include "gst/scream/rx/link_reports.h"
#include "tests/elements/scream/rtp_support.h"

namespace lidar::test {
namespace {

using namespace std::chrono_literals;
using gst::LinkReports;
using gst::PeerLatch;
using gst::SeenPackets;
using LinkAddress = std::unique_ptr<GSocketAddress, gst::GObjectUnref>;
using Verdict = PeerLatch::Verdict;

struct PeerLinks : ::testing::Test {
  /// Sends a packet from the address `from`. Packets with the same number and salt have the same
  /// bytes.
  Verdict Send(const LinkAddress& from, std::uint16_t number, std::uint64_t salt = 1) {
    return latch.OnPacket(now, {from.get(), 1, number, {}, number * 1000003U + salt});
  }
  /// Sends each packet over both links, first over `sooner`. The packets are 10 ms apart.
  void SendBoth(const LinkAddress& sooner, const LinkAddress& later, int packets) {
    for (int i = 0; i < packets; ++i, ++seq, now += 10ms) {
      Send(sooner, seq);
      Send(later, seq);
    }
  }

  LinkAddress first{Address("10.0.0.1", 5000)};
  LinkAddress second{Address("10.1.0.1", 5000)};
  LinkAddress thief{Address("10.2.0.1", 5000)};
  PeerLatch latch;
  Time now{1s};
  std::uint16_t seq = 65530;
};

TEST_F(PeerLinks, NoCopiesTakeThePlaceOfALinkThatSends) {
  std::vector<LinkAddress> links;
  for (guint i = 0; i < PeerLatch::kMaxLinks; ++i)
    links.emplace_back(Address("10.3.0.1", 5000 + i));
  /// Sends each packet over all links, and then a copy from the thief. Returns how many copies of
  /// the thief were accepted.
  const auto send_all = [&](int packets) {
    int accepted = 0;
    for (int i = 0; i < packets; ++i, ++seq, now += 10ms) {
      for (const LinkAddress& link : links) Send(link, seq);
      accepted += Send(thief, seq) != Verdict::kForeign;
    }
    return accepted;
  };
  EXPECT_EQ(send_all(3 * PeerLatch::kCopies), 0);
  EXPECT_EQ(latch.links(), PeerLatch::kMaxLinks);
  for (const LinkAddress& link : links) EXPECT_TRUE(latch.IsPeer(link.get()));
  EXPECT_FALSE(latch.IsPeer(thief.get()));
  links.pop_back();
  now += PeerLatch::kPeerSilence;
  EXPECT_EQ(send_all(1), 1);
  EXPECT_EQ(latch.links(), PeerLatch::kMaxLinks);
  EXPECT_TRUE(latch.IsPeer(thief.get())) << "in the place of the silent one";
}

TEST_F(PeerLinks, CopiesMakeAnAddressALink) {
  SendBoth(first, second, PeerLatch::kCopies - 1);
  EXPECT_EQ(latch.links(), 1U);
  SendBoth(first, second, 1);
  EXPECT_EQ(latch.links(), 2U);
  EXPECT_TRUE(latch.IsPeer(second.get()));
  EXPECT_EQ(Send(second, seq), Verdict::kAccepted);
}

TEST_F(PeerLinks, PacketsAreComparedWhileAnotherAddressSendsOrMay) {
  const auto wanted = [this] {
    return std::pair(latch.WantsDigest(first.get()), latch.WantsDigest(second.get()));
  };
  EXPECT_EQ(wanted(), std::pair(true, true)) << "nobody is the peer";
  Send(first, seq++);
  EXPECT_EQ(wanted(), std::pair(false, true)) << "of the peer alone";
  Send(second, seq);
  EXPECT_EQ(wanted(), std::pair(true, true)) << "beside a stranger";
  SendBoth(first, second, PeerLatch::kCopies);
  EXPECT_EQ(latch.links(), 2U);
  EXPECT_EQ(wanted(), std::pair(true, true)) << "of a link";
}

TEST_F(PeerLinks, CopiesThatComeBeforeTheirOriginalsCountToo) {
  Send(first, seq++);
  SendBoth(second, first, PeerLatch::kCopies);
  EXPECT_EQ(Send(second, seq), Verdict::kAccepted);
  EXPECT_EQ(latch.links(), 2U);
}

// The first packets have no digest, because digests are computed only after a second address has
// sent packets.
TEST_F(PeerLinks, ALinkThatRunsAheadAtTheStartIsNoRival) {
  for (std::uint16_t n = 0; n < PeerLatch::kProbation; ++n)
    latch.OnPacket(now, {first.get(), 1, static_cast<std::uint16_t>(seq + n), {}});
  for (int i = 0; i <= PeerLatch::kProbation; ++i)
    EXPECT_EQ(Send(second, seq++), Verdict::kForeign) << i;
  Send(first, static_cast<std::uint16_t>(seq - 1));
  SendBoth(first, second, PeerLatch::kCopies - 1);
  EXPECT_EQ(latch.links(), 2U);
  EXPECT_TRUE(gst::SameAddress(latch.peer(), first.get()));
}

TEST_F(PeerLinks, AStrangerWithTheSameSsrcAndNumbersStaysOne) {
  for (int i = 0; i < 1000; ++i, ++seq, now += 10ms) {
    EXPECT_EQ(Send(first, seq), Verdict::kAccepted);
    EXPECT_EQ(Send(thief, seq, 2), Verdict::kForeign) << "other bytes";
  }
  EXPECT_EQ(latch.links(), 1U);
}

TEST_F(PeerLinks, OneCopySentAgainAndAgainIsOne) {
  Send(first, seq);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(Send(thief, seq), Verdict::kForeign);
  EXPECT_EQ(latch.links(), 1U);
}

TEST_F(PeerLinks, ThePeerGoesOnOverTheOtherLinkAndNoStrangerTakesItsPlace) {
  SendBoth(first, second, 10);
  for (int i = 0; i < 1000; ++i, ++seq, now += 10ms) {
    EXPECT_EQ(Send(second, seq), Verdict::kAccepted);
    EXPECT_EQ(Send(thief, seq, 2), Verdict::kForeign);
  }
  EXPECT_TRUE(gst::SameAddress(latch.peer(), second.get())) << "it is answered there";
  EXPECT_EQ(Send(first, seq), Verdict::kAccepted) << "and back";
}

TEST_F(PeerLinks, WhoeverTakesThePlaceOfASilentPeerHasNoneOfItsLinks) {
  SendBoth(first, second, 10);
  now += 10s;
  for (int i = 0; i < 10; ++i, ++seq, now += 10ms) Send(thief, seq, 2);
  EXPECT_TRUE(latch.IsPeer(thief.get()));
  EXPECT_FALSE(latch.IsPeer(second.get()));
  EXPECT_EQ(latch.links(), 1U);
}

TEST_F(PeerLinks, AreFewAndASilentOneGivesItsPlaceToANewOne) {
  Send(first, seq++);
  for (int host = 1; host < 200; ++host) {
    const LinkAddress other(Address(("10.3.0." + std::to_string(host)).c_str(), 5000));
    SendBoth(first, other, 6);
    EXPECT_LE(latch.links(), PeerLatch::kMaxLinks);
    now += 600ms;
    Send(first, seq++);
  }
  const LinkAddress newest(Address("10.3.0.199", 5000));
  EXPECT_TRUE(latch.IsPeer(newest.get()));
  EXPECT_TRUE(latch.IsPeer(first.get()));
}

TEST_F(PeerLinks, ASilentFirstLinkGivesItsPlaceAtOnce) {
  std::vector<LinkAddress> others;
  for (guint i = 0; i + 1 < PeerLatch::kMaxLinks; ++i) {
    others.emplace_back(Address("10.3.0.1", 5000 + i));
    SendBoth(first, others.back(), PeerLatch::kCopies + 1);
  }
  ASSERT_EQ(latch.links(), PeerLatch::kMaxLinks);
  for (const Time end = now + PeerLatch::kPeerSilence + 50ms; now < end; now += 10ms, ++seq)
    for (const LinkAddress& other : others) Send(other, seq);
  SendBoth(others.front(), second, PeerLatch::kCopies + 1);
  EXPECT_TRUE(latch.IsPeer(second.get()));
  EXPECT_FALSE(latch.IsPeer(first.get()));
}

TEST_F(PeerLinks, OneWhoseAddressChangesEachSecondGoesOn) {
  int lost = 0;
  for (int change = 0; change < 600; ++change) {
    const LinkAddress moved(Address("10.1.0.1", 5000 + static_cast<guint>(change)));
    for (int i = 0; i < 100; ++i, ++seq, now += 10ms) {
      EXPECT_EQ(Send(first, seq), Verdict::kAccepted);
      lost += Send(moved, seq) == Verdict::kForeign;
      EXPECT_EQ(Send(thief, seq, 2), Verdict::kForeign);
    }
    EXPECT_TRUE(latch.IsPeer(moved.get())) << change;
    EXPECT_LE(latch.links(), PeerLatch::kMaxLinks);
  }
  EXPECT_TRUE(gst::SameAddress(latch.peer(), first.get()));
  EXPECT_LE(lost, 600 * PeerLatch::kCopies) << "no more than what proves an address";
}

TEST_F(PeerLinks, GoOnWhereEachOfTwoAddressesChangesInTurn) {
  LinkAddress one(Address("10.0.0.1", 5000)), other(Address("10.1.0.1", 5000));
  SendBoth(one, other, 10);
  for (guint change = 1; change < 600; ++change) {
    (change % 2 == 0 ? one : other).reset(Address("10.1.0.1", 5000 + change));
    int accepted = 0;
    for (int i = 0; i < 100; ++i, ++seq, now += 10ms) {
      const bool first_came = Send(one, seq) == Verdict::kAccepted;
      accepted += Send(other, seq) == Verdict::kAccepted || first_came;
    }
    EXPECT_EQ(accepted, 100) << "change " << change;
    EXPECT_TRUE(latch.IsPeer(one.get()) && latch.IsPeer(other.get()));
    EXPECT_LE(latch.links(), PeerLatch::kMaxLinks);
  }
}

TEST(LinkStats, HaveEachItsOwnName) {
  gst::BondLinkStats stats;
  stats.link = "edge:5004@wwan0";
  stats.counters = {11, 12, 13, 14, 15};
  stats.bottleneck = 16;
  const auto shown = [&stats] {
    StructurePtr out(gst_structure_new_empty("link"));
    gst::AddLinkStats(stats, out.get());
    return out;
  };
  const Stats all(shown().get());
  EXPECT_EQ(all.Text("link"), "edge:5004@wwan0");
  EXPECT_EQ(all["packets-first"], 11U);
  EXPECT_EQ(all["packets-copies"], 12U);
  EXPECT_EQ(all["copies-cancelled"], 13U);
  EXPECT_EQ(all["packets-saved"], 14U);
  EXPECT_EQ(all["link-gaps"], 15U);
  EXPECT_EQ(all["bottleneck"], 16U);
  for (const bool usable : {false, true}) {
    stats.usable = usable;
    stats.in_gap = !usable;
    const Stats now_shown(shown().get());
    EXPECT_EQ(now_shown.True("usable"), usable);
    EXPECT_EQ(now_shown.True("in-gap"), !usable);
  }
}

/// Sends packets and their copies in random order, while the sequence numbers wrap.
TEST(SeenPackets, PassEachOfManyOnceOverTheWrapOfTheirNumbers) {
  SeenPackets seen;
  std::mt19937 random(9);
  std::set<unsigned> came;
  unsigned front = 65'000;
  for (int i = 0; i < 20'000; ++i) {
    const auto n =
        static_cast<unsigned>(front + random() % 3 - (random() % 4 == 0 ? random() % 500 : 0));
    EXPECT_EQ(seen.Add(1, static_cast<std::uint16_t>(n), n), came.insert(n).second) << n;
    front = std::max(front, n);
  }
  EXPECT_GT(front, 65'536U + 1'000);
}

TEST(LinkReports, TellEachLinkWhatCameByIt) {
  const LinkAddress a(Address("10.0.0.1", 5000)), b(Address("10.1.0.1", 5000));
  LinkReports reports;
  reports.Reset({});
  Time now{1s};
  for (std::uint16_t seq = 0; seq < 40; ++seq, now += 1ms)
    reports.OnPacket(seq % 4 == 0 ? b.get() : a.get(), now,
                     {7, seq, Ecn::kEct1, true, DataSize::Bytes(1200)});
  int from_a = 0, from_b = 0;
  while (const auto report = reports.Take(now)) {
    const bool is_b = gst::SameAddress(report->to, b.get());
    const rtcp::SsrcReport& block = report->feedback.blocks.at(0);
    for (std::size_t i = 0; i < block.metrics.size(); ++i) {
      const auto seq = static_cast<std::uint16_t>(block.begin_seq + i);
      EXPECT_EQ(block.metrics[i].received, (seq % 4 == 0) == is_b) << seq;
      (is_b ? from_b : from_a) += block.metrics[i].received;
    }
  }
  EXPECT_EQ(from_a, 30);
  EXPECT_EQ(from_b, 10);
  EXPECT_EQ(reports.Sum().packets, 40U);
  EXPECT_EQ(reports.stats().size(), 2U);
}

TEST(LinkReports, FollowChangedSettingsOnLinksOfBeforeAndOnNewOnes) {
  const LinkAddress a(Address("10.0.0.1", 5000)), b(Address("10.1.0.1", 5000));
  LinkReports reports;
  reports.Reset({});
  Time now{1s};
  std::uint16_t seq = 0;
  const auto due_after = [&](const LinkAddress& link, int packets) {
    for (int i = 0; i < packets; ++i)
      reports.OnPacket(link.get(), now, {7, seq++, Ecn::kEct1, false, DataSize::Bytes(1200)});
    return reports.Take(now).has_value();
  };
  EXPECT_TRUE(due_after(a, 1)) << "the first packet of all";
  rtcp::FeedbackConfig config;
  config.sender_ssrc = 77;
  config.packets_per_feedback = 3;
  reports.set_config(config);
  EXPECT_TRUE(due_after(b, 1));
  for (const LinkAddress* link : {&a, &b}) {
    EXPECT_FALSE(due_after(*link, 2));
    now += 1ms;
    reports.OnPacket(link->get(), now, {7, seq++, Ecn::kEct1, false, DataSize::Bytes(1200)});
    const auto report = reports.Take(now);
    ASSERT_TRUE(report);
    EXPECT_EQ(report->feedback.sender_ssrc, 77U);
  }
}

TEST(LinkReports, SumUpEachCountOfAllLinks) {
  const LinkAddress a(Address("10.0.0.1", 5000)), b(Address("10.1.0.1", 5000));
  LinkReports reports;
  reports.Reset({});
  Time now{1s};
  const auto send = [&](const LinkAddress& link, std::uint16_t seq) {
    reports.OnPacket(link.get(), now,
                     {7, seq, seq % 3 == 0 ? Ecn::kCe : Ecn::kEct1, true, DataSize::Bytes(1200)});
    now += 1ms;
    while (reports.Take(now)) continue;
  };
  for (const LinkAddress* link : {&a, &b}) {
    for (std::uint16_t seq = 3'000; seq < 6'000; seq = static_cast<std::uint16_t>(seq + 2))
      send(*link, seq);
    for (const int late : {5'998, 5'997, 3'001}) send(*link, static_cast<std::uint16_t>(late));
  }
  using Stats = rtcp::FeedbackGenerator::Stats;
  const auto all = reports.stats();
  for (const auto count : {&Stats::packets, &Stats::ce_packets, &Stats::duplicates,
                           &Stats::reordered, &Stats::stale, &Stats::lost, &Stats::reports}) {
    EXPECT_GT(all[0].feedback.*count, 0U);
    EXPECT_EQ(reports.Sum().*count, all[0].feedback.*count + all[1].feedback.*count);
  }
  for (const auto size : {&Stats::received, &Stats::sent}) {
    EXPECT_GT(all[0].feedback.*size, DataSize());
    EXPECT_EQ(reports.Sum().*size, all[0].feedback.*size + all[1].feedback.*size);
  }
}

TEST(LinkReports, KeepFewLinksWhereAddressesChangeAllTheTime) {
  LinkReports reports;
  reports.Reset({});
  Time now{1s};
  for (int host = 1; host < 250; ++host, now += 1s) {
    const LinkAddress a(Address(("10.0.0." + std::to_string(host)).c_str(), 5000));
    reports.OnPacket(a.get(), now, {7, 1, Ecn::kEct1, true, DataSize::Bytes(1200)});
  }
  EXPECT_EQ(reports.stats().size(), LinkReports::kMaxLinks);
  EXPECT_EQ(reports.Sum().packets, 249U);
  reports.Reset({});
  EXPECT_TRUE(reports.stats().empty());
  EXPECT_EQ(reports.Sum().packets, 0U) << "of links that were replaced, either";
}

TEST(LinkReports, KeepTheLinkInUse) {
  LinkReports reports;
  reports.Reset({});
  Time now{1s};
  const LinkAddress in_use(Address("10.1.0.1", 5000));
  for (int host = 1; host < 100; ++host) {
    const LinkAddress other(Address(("10.0.0." + std::to_string(host)).c_str(), 5000));
    for (const LinkAddress* from : {&in_use, &other})
      reports.OnPacket(from->get(), now += 1s, {7, 1, Ecn::kEct1, true, DataSize::Bytes(1200)});
  }
  EXPECT_EQ(reports.stats().at(0).feedback.packets, 99U);
}

TEST(SeenPackets, PassEachPacketOnceInWhateverOrder) {
  SeenPackets seen;
  for (const int number : {65534, 65535, 1, 0, 300, 2}) {
    const auto seq = static_cast<std::uint16_t>(number);
    EXPECT_TRUE(seen.Add(7, seq, 9)) << seq;
    EXPECT_FALSE(seen.Add(7, seq, 9)) << seq;
  }
  EXPECT_TRUE(seen.Add(8, 300, 9)) << "of another SSRC";
}

TEST(SeenPackets, ASenderThatStartsAgainIsNotKeptOut) {
  SeenPackets seen;
  for (const std::uint32_t begin : {20000U, 0U, 15000U})
    for (std::uint32_t i = 0; i < 20000; ++i)
      EXPECT_TRUE(seen.Add(7, static_cast<std::uint16_t>(begin + i), begin * i)) << begin + i;
}

TEST(SeenPackets, ForgetOneOfManySsrcs) {
  SeenPackets seen;
  for (std::uint32_t ssrc = 0; ssrc < 100000; ++ssrc) EXPECT_TRUE(seen.Add(ssrc, 1, 9));
}

}  // namespace
}  // namespace lidar::test
