// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that the receiver does not count slices and scans as lost if the sender skipped them.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "src/rtp/receiver.h"
#include "tests/core/rtp/stream.h"

namespace lidar::rtp {
namespace {

using test::DeliverAll;
using test::kReorder;
using test::Sender;
using test::SenderOptions;
using test::Wire;
using Names = std::vector<std::string>;

/// Returns the accounts as "skipped n lost n; scans complete incomplete lost".
std::string SkipAccounts(const Receiver& r) {
  const SliceAccounts a = r.accounts().slices;
  return "skipped " + std::to_string(a.slices_skipped) + " lost " + std::to_string(a.slices_lost) +
         "; scans " + std::to_string(a.scans_complete) + " " + std::to_string(a.scans_incomplete) +
         " " + std::to_string(a.scans_lost);
}

TEST(SkippedSlices, AreNotLost) {
  Receiver receiver(kReorder);
  Sender sender;
  // The sender skips slice 2 of each scan, slice 3 of the even scans, and slice 0 of the odd scans.
  DeliverAll(&receiver, sender.ScansWithout(20, [](std::uint32_t s, std::uint16_t i) {
    return i == 2 || (s % 2 == 0 && i == 3) || (s % 2 == 1 && i == 0);
  }));
  receiver.Finish();
  // The first scan counts from the slice where the receiver joined, and the last scan ends with the
  // stream.
  EXPECT_EQ(SkipAccounts(receiver), "skipped 40 lost 0; scans 20 0 0");
  EXPECT_EQ(receiver.accounts().slices.slices_received, 40U);
}

TEST(SkippedSlices, AreToldFromLostOnesEvenWhereTheNextSliceIsLostToo) {
  Receiver receiver(kReorder);
  Sender sender;
  auto packets = sender.ScansWithout(
      10, [](std::uint32_t s, std::uint16_t i) { return s == 4 && (i == 1 || i == 2); });
  // Slice 4.3 is the first slice that names the skipped slices. It is lost.
  Lose(&packets, [](const Wire& w) { return w.scan == 4 && w.index == 3; });
  DeliverAll(&receiver, packets);
  receiver.Finish();
  EXPECT_EQ(SkipAccounts(receiver), "skipped 2 lost 1; scans 9 1 0");
  EXPECT_EQ(receiver.accounts().slices.slices_received, 37U);
}

TEST(SkippedSlices, AreNotLostWhereTheWordOfThemComesLate) {
  Receiver receiver(kReorder);
  Sender sender;
  auto packets = sender.ScansWithout(
      6, [](std::uint32_t s, std::uint16_t i) { return (s == 2 && i == 3) || (s == 3 && i < 2); });
  // A sender with too little capacity pauses within the slice that names the skipped slices. Its
  // last packet arrives when the skipped slices are already overdue.
  const auto told = [](const Wire& w) { return w.scan == 3 && w.index == 2; };
  const auto begun = std::find_if(packets.begin(), packets.end(), told);
  ASSERT_TRUE(told(*(begun + 1)));
  for (auto w = begun + 1; w != packets.end(); ++w) w->sent += kReorder * 3 / 2;
  DeliverAll(&receiver, packets);
  EXPECT_EQ(receiver.accounts().slices.slices_lost, 0U);
  receiver.Finish();
  EXPECT_EQ(SkipAccounts(receiver), "skipped 3 lost 0; scans 6 0 0");
}

TEST(SkippedSlices, AreNotLostInAnOutage) {
  Receiver receiver(kReorder);
  Sender sender;
  auto packets = sender.ScansWithout(
      20, [](std::uint32_t s, std::uint16_t i) { return s == 11 || (s == 12 && i < 2) || i == 3; });
  // No packet of scans 5 to 11 arrives. Scan 11 has no scan number, because all its slices were
  // skipped.
  Lose(&packets, [](const Wire& w) { return !w.config && w.scan >= 5 && w.scan <= 11; });
  DeliverAll(&receiver, packets);
  receiver.Finish();
  const auto a = receiver.accounts();
  EXPECT_EQ(a.outages, 1U);
  EXPECT_EQ(a.slices.slices_received, 5U * 3 + 1 + 7 * 3);
  // Slice 12.2 names all skipped slices among the 64 slices before it.
  EXPECT_EQ(a.slices.slices_lost, 6U * 3);
  EXPECT_EQ(a.slices.scans_skipped, 1U);
}

TEST(SkippedSlices, AreNotLostWhereTheWordOfThemComesAfterAnOutage) {
  Receiver receiver(kReorder);
  Sender sender;
  auto packets = sender.ScansWithout(
      20, [](std::uint32_t s, std::uint16_t i) { return s == 4 && (i == 1 || i == 2); });
  // Of slice 4.3, which names the skipped slices, only one packet arrives. Scans 5 to 9 are lost.
  bool first = true;
  Lose(&packets, [&](const Wire& w) {
    if (w.config) return false;
    if (w.scan != 4 || w.index != 3) return w.scan >= 5 && w.scan <= 9;
    return !std::exchange(first, false);
  });
  DeliverAll(&receiver, packets);
  receiver.Finish();
  const auto a = receiver.accounts();
  EXPECT_EQ(a.outages, 1U);
  EXPECT_EQ(a.slices.slices_received, 4U * 4 + 1 + 10 * 4);
  EXPECT_EQ(a.slices.slices_skipped, 2U);
  EXPECT_EQ(a.slices.slices_lost, 1U + 5 * 4);
}

TEST(SkippedSlices, DoNotInterruptTheStream) {
  Receiver receiver(kReorder);
  Sender sender;
  unsigned disconts = 0;
  for (const Wire& w :
       sender.ScansWithout(20, [](std::uint32_t, std::uint16_t i) { return i == 1; })) {
    for (const ReceivedSlice& s : test::Deliver(&receiver, w)) disconts += s.discont ? 1U : 0U;
  }
  EXPECT_EQ(disconts, 1U);  // This is the first slice of the stream.
}

TEST(SkippedScans, AreCountedWhateverIsLostBesides) {
  for (const bool outage : {false, true}) {
    Receiver receiver(kReorder);
    Sender sender;
    auto packets = sender.ScansWithout(
        40, [](std::uint32_t s, std::uint16_t) { return s % 4 == 1 || s % 4 == 2; });
    Lose(&packets, [&](const Wire& w) {
      const bool cut = outage && w.scan > 5 && w.scan < 30;
      return !w.config && (cut || w.scan == 4 || w.index == 2);
    });
    DeliverAll(&receiver, packets);
    receiver.Finish();
    EXPECT_EQ(receiver.accounts().slices.scans_skipped, 20U);
    EXPECT_EQ(receiver.accounts().outages, outage ? 1U : 0U);
  }
}

TEST(SkippedScans, AreNoneWhereTheSourceStartsItsNumbersAnew) {
  Receiver receiver(kReorder);
  Sender sender;
  DeliverAll(&receiver, sender.Scans(50, 3));
  SenderOptions again;
  again.scan_number += 53;  // continues the numbers; the source begins with scan id 0
  DeliverAll(&receiver, Sender(again).Scans(0, 3));
  EXPECT_EQ(receiver.accounts().slices.scans_skipped, 0U);
}

TEST(SkippedScans, AreNotThoseOfWhichAPartWasLost) {
  Receiver receiver(kReorder);
  Sender sender;
  auto packets =
      sender.ScansWithout(10, [](std::uint32_t s, std::uint16_t i) { return s == 4 && i < 2; });
  Lose(&packets, [](const Wire& w) { return w.scan == 4; });
  DeliverAll(&receiver, packets);
  receiver.Finish();
  EXPECT_EQ(SkipAccounts(receiver), "skipped 2 lost 2; scans 9 0 1");
  EXPECT_EQ(receiver.accounts().slices.scans_skipped, 0U);
}

/// Returns a slice that falsely claims that all slices before it were skipped.
std::vector<Wire> Liar(Sender* sender, std::uint32_t scan, std::uint16_t index) {
  ScanCounter counter(SenderOptions{}.scan_number + scan - 1);
  Unit before;
  before.slice = {0, 0, 200};
  before.info.scan_id = scan - 1;
  counter.Place(&before);
  std::vector<Wire> out;
  sender->Slice(scan, index, &out, &counter);
  return out;
}

TEST(SkippedSlices, AreNotThoseThatArrivedOrArriveNow) {
  Receiver receiver(kReorder);
  Sender sender;
  DeliverAll(&receiver, sender.Scans(0, 2));
  std::vector<Wire> begun;
  sender.Slice(2, 0, &begun);
  std::vector<Wire> next;
  sender.Slice(2, 1, &next);
  ASSERT_GT(begun.size(), 1U);
  Names names = DeliverAll(&receiver, {begun.begin(), begun.end() - 1});
  EXPECT_EQ(names, Names{});
  EXPECT_EQ(DeliverAll(&receiver, Liar(&sender, 2, 2)), Names{"2.2"});
  EXPECT_EQ(DeliverAll(&receiver, {begun.back()}), Names{"2.0"});
  // The claim counts for slice 2.1, because that slice had not arrived. The other slices stay
  // received.
  EXPECT_EQ(DeliverAll(&receiver, next), Names{});
  std::vector<Wire> last;
  sender.Slice(2, 3, &last);
  DeliverAll(&receiver, last);
  receiver.Finish();
  EXPECT_EQ(SkipAccounts(receiver), "skipped 1 lost 0; scans 3 0 0");
  EXPECT_EQ(receiver.accounts().slices.slices_received, 11U);
}

TEST(SkippedSlices, OfAWholeScanMakeNoCompleteScan) {
  Receiver receiver(kReorder);
  Sender sender;
  DeliverAll(&receiver, sender.Scans(0, 2));
  DeliverAll(&receiver, Liar(&sender, 3, 0));  // The claim includes all of scan 2.
  receiver.Finish();
  EXPECT_EQ(SkipAccounts(receiver), "skipped 4 lost 0; scans 2 1 0");
  EXPECT_EQ(receiver.accounts().slices.scans_skipped, 1U);
}

TEST(SkippedSlices, AreNotBelievedOfADamagedSlice) {
  Receiver receiver(kReorder);
  Sender sender;
  DeliverAll(&receiver, sender.Scans(0, 2));
  auto liar = Liar(&sender, 2, 2);
  liar.back().payload.back() ^= 1;
  DeliverAll(&receiver, liar);
  DeliverAll(&receiver, sender.Scans(3, 3));
  receiver.Finish();
  EXPECT_EQ(receiver.accounts().slices.slices_skipped, 0U);
  EXPECT_EQ(receiver.accounts().slices.slices_damaged, 1U);
  EXPECT_EQ(receiver.accounts().slices.slices_lost, 3U);
}

}  // namespace
}  // namespace lidar::rtp
