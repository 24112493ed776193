// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rtp/slice_ledger.h"

#include <gtest/gtest.h>

namespace lidar::rtp {
namespace {

using std::chrono::milliseconds;

class Ledger : public ::testing::Test {
 protected:
  Admission Admit(std::int64_t scan, std::uint32_t index, std::uint32_t count, int at_ms = 0) {
    return ledger.Admit({scan, index}, count, Time{milliseconds(at_ms)});
  }
  void Receive(std::int64_t scan, std::uint32_t index, std::uint32_t count = 4, int at_ms = 0) {
    ASSERT_EQ(Admit(scan, index, count, at_ms), Admission::kOpen);
    ledger.Settle({scan, index}, SliceOutcome::kReceived);
  }
  const SliceAccounts& accounts() { return ledger.accounts(); }

  SliceLedger ledger{milliseconds(100)};
};

TEST_F(Ledger, AScanHasOneCountOfSlices) {
  Receive(1, 0);
  EXPECT_EQ(Admit(1, 1, 8), Admission::kContradiction);
  EXPECT_EQ(Admit(1, 5, 8), Admission::kContradiction);
  EXPECT_EQ(Admit(1, 1, 3), Admission::kContradiction);
  EXPECT_EQ(Admit(1, 3, 4), Admission::kOpen);
  EXPECT_EQ(Admit(2, 5, 8), Admission::kOpen);  // The next scan may have another count.
}

TEST_F(Ledger, AScanHasOneCountAlsoBeforeASliceOfItIsWhole) {
  EXPECT_EQ(Admit(1, 0, 4), Admission::kOpen);
  EXPECT_EQ(Admit(1, 1, 8), Admission::kContradiction);
  EXPECT_EQ(Admit(1, 1, 4), Admission::kOpen);
}

TEST_F(Ledger, WhatWasBeforeTheFirstSliceIsTooOld) {
  Receive(5, 2);
  EXPECT_EQ(Admit(5, 1, 4), Admission::kTooOld);
  EXPECT_EQ(Admit(4, 3, 4), Admission::kTooOld);
  EXPECT_EQ(Admit(5, 2, 4), Admission::kSettled);
  EXPECT_EQ(Admit(5, 3, 4), Admission::kOpen);
}

TEST_F(Ledger, ASliceIsOverdueOnceOneBehindItWasSeenLongEnoughAgo) {
  Receive(1, 0, 4, 0);
  Receive(1, 2, 4, 10);
  EXPECT_FALSE(ledger.Overdue(Time{milliseconds(99)}));
  const auto first = ledger.Overdue(Time{milliseconds(109)});
  EXPECT_TRUE(!first || !(SlicePosition{1, 1} < *first));
  const auto limit = ledger.Overdue(Time{milliseconds(110)});
  ASSERT_TRUE(limit);
  EXPECT_TRUE((*limit == SlicePosition{1, 2}));
  ledger.CloseBefore(*limit);
  EXPECT_FALSE(ledger.Overdue(Time{milliseconds(110)})) << "closed";
  EXPECT_EQ(accounts().slices_lost, 1U);
  EXPECT_EQ(Admit(1, 1, 4, 120), Admission::kTooOld);
}

TEST_F(Ledger, BooksEachScanOnce) {
  for (std::uint32_t i = 0; i < 4; ++i) Receive(1, i);
  EXPECT_EQ(accounts().scans_complete, 1U);
  Receive(2, 0);
  Receive(4, 0);  // Nothing was received of scan 3.
  ledger.Finish();
  EXPECT_EQ(accounts().slices_received, 6U);
  EXPECT_EQ(accounts().slices_lost, 3U + 4);  // Slices after the newest slice do not count.
  EXPECT_EQ(accounts().scans_complete, 1U);
  EXPECT_EQ(accounts().scans_lost, 1U);
}

TEST_F(Ledger, ASkippedSliceStaysSkippedIfItsScanBeginsLater) {
  Receive(1, 0, 1);
  Receive(3, 0);
  for (const std::uint32_t index : {3U, 2U, 1U}) ledger.Skip({2, index});
  Receive(2, 0);
  ledger.CloseBefore({3, 0});
  EXPECT_EQ(accounts().slices_skipped, 3U);
  EXPECT_EQ(accounts().slices_lost, 0U);
  EXPECT_EQ(accounts().scans_complete, 2U);
}

TEST_F(Ledger, AScanThatBeginsLateHasItsOwnCountOfSlices) {
  Receive(1, 0, 1);
  Receive(4, 0);  // For now, scans 2 and 3 are assumed to have four slices, too.
  Receive(2, 7, 8);
  Receive(3, 1, 2);
  EXPECT_EQ(Admit(2, 3, 4), Admission::kContradiction);
  ledger.CloseBefore({4, 0});
  EXPECT_EQ(accounts().slices_received, 4U);
  EXPECT_EQ(accounts().slices_lost, 7U + 1);
  EXPECT_EQ(accounts().scans_complete, 1U);
  EXPECT_EQ(accounts().scans_incomplete, 2U);
}

/// A slice names up to 64 skipped slices. At worst, they belong to 64 scans.
TEST_F(Ledger, NewsOfAScanAreTakenForSixtyFourScansAndNoLonger) {
  for (const std::int64_t end : {66, 67}) {
    ledger.StartAnew();
    Receive(1, 0);
    Receive(2, 0);
    for (std::int64_t scan = 3; scan <= end; ++scan) {
      for (std::uint32_t i = 0; i < 4; ++i) Receive(scan, i);
      ledger.CloseBefore({scan, 0});
    }
    EXPECT_EQ(accounts().slices_lost, 6U) << end;
    EXPECT_EQ(accounts().scans_incomplete, 2U) << end;
    for (const std::uint32_t index : {1U, 2U, 3U}) ledger.Skip({2, index});
    const bool known = end == 66;
    EXPECT_EQ(accounts().slices_skipped, known ? 3U : 0U) << end;
    EXPECT_EQ(accounts().slices_lost, known ? 3U : 6U) << end;
    EXPECT_EQ(accounts().scans_incomplete, known ? 1U : 2U) << end;
  }
}

TEST_F(Ledger, CountsScansThatTheSourceSkippedOnceThoughAScanComesLate) {
  ledger.BookScanId(1, 10);
  ledger.BookScanId(3, 14);  // One of the ids 11 to 13 belongs to scan 2.
  EXPECT_EQ(accounts().scans_skipped, 2U);
  ledger.BookScanId(2, 11);
  EXPECT_EQ(accounts().scans_skipped, 2U);
  ledger.BookScanId(4, 15);
  EXPECT_EQ(accounts().scans_skipped, 2U);
  ledger.BookScanId(4, 15);  // a second slice of scan 4
  ledger.BookScanId(5, 2);   // The source starts its ids again.
  ledger.BookScanId(6, 4);
  EXPECT_EQ(accounts().scans_skipped, 3U);
}

TEST_F(Ledger, AScanKeepsItsCountOnceOneOfItsSlicesIsCounted) {
  Receive(1, 0, 1);
  Receive(3, 0);
  ledger.Skip({2, 3});
  EXPECT_EQ(Admit(2, 0, 8), Admission::kContradiction);
  EXPECT_EQ(Admit(2, 0, 4), Admission::kOpen);
}

TEST_F(Ledger, ASliceBeforeAnotherMayBeOfTheScanBefore) {
  Receive(1, 0);
  Receive(2, 1);
  EXPECT_TRUE((ledger.Before({2, 1}) == SlicePosition{2, 0}));
  EXPECT_TRUE((ledger.Before({2, 0}) == SlicePosition{1, 3}));
}

TEST_F(Ledger, AddsUpEachOfItsCounts) {
  const SliceAccounts one{1, 2, 3, 4, 5, 6, 7, 8, 9};
  SliceAccounts sum = one;
  sum += one;
  EXPECT_EQ(sum.slices_received, 2U);
  EXPECT_EQ(sum.slices_lost, 4U);
  EXPECT_EQ(sum.slices_damaged, 6U);
  EXPECT_EQ(sum.slices_config_mismatch, 8U);
  EXPECT_EQ(sum.slices_skipped, 10U);
  EXPECT_EQ(sum.scans_complete, 12U);
  EXPECT_EQ(sum.scans_incomplete, 14U);
  EXPECT_EQ(sum.scans_lost, 16U);
  EXPECT_EQ(sum.scans_skipped, 18U);
}

}  // namespace
}  // namespace lidar::rtp
