// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cloud/slicing.h"

#include <gtest/gtest.h>

namespace lidar {
namespace {

using std::chrono::milliseconds;

TEST(Slicing, AutomaticSweepsAreTwelveAndAHalfMilliseconds) {
  EXPECT_EQ(AutomaticSlices({1024, 64, milliseconds(100)}), 8U);
  EXPECT_EQ(AutomaticSlices({2048, 128, milliseconds(100)}), 8U);
  EXPECT_EQ(AutomaticSlices({1024, 128, milliseconds(50)}), 4U);
}

TEST(Slicing, AutomaticSweepsAreTheNearestToThat) {
  // At 12 scans/s, a scan has the duration of 6.7 sweeps of 12.5 ms.
  EXPECT_EQ(AutomaticSlices({1008, 128, std::chrono::microseconds(83'333)}), 7U);
  // At 15 scans/s, a scan has the duration of 5.3 sweeps.
  EXPECT_EQ(AutomaticSlices({900, 128, std::chrono::microseconds(66'667)}), 5U);
}

TEST(Slicing, AutomaticSlicesHoldTwoThousandPoints) {
  EXPECT_EQ(AutomaticSlices({512, 32, milliseconds(100)}), 8U);
  EXPECT_EQ(AutomaticSlices({512, 16, milliseconds(100)}), 4U);
  EXPECT_EQ(AutomaticSlices({512, 1, milliseconds(100)}), 1U);
}

TEST(Slicing, ACountThatDoesNotDivideTheColumnsIsRoundedDown) {
  const ScanShape scan{1024, 64, milliseconds(100)};
  EXPECT_EQ(SlicesPerScan(0, scan), 8U);
  EXPECT_EQ(SlicesPerScan(1, scan), 1U);
  EXPECT_EQ(SlicesPerScan(7, scan), 4U);
  EXPECT_EQ(SlicesPerScan(16, scan), 16U);
  EXPECT_EQ(SlicesPerScan(1'000'000'000, scan), 1024U);
  EXPECT_EQ(SlicesPerScan(8, {900, 64, milliseconds(100)}), 6U);
}

}  // namespace
}  // namespace lidar
