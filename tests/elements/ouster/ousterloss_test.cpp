// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of the reports of ouster_src about lost packets.
#include <gtest/gtest.h>

#include "ext/ouster/loss_report.h"

namespace lidar::test {
namespace {

TEST(OusterLossReport, TellsEachLossOnceAndASecondApart) {
  gst::LossReport report;
  using Lost = std::optional<guint64>;
  EXPECT_EQ(report.Take(0, 0), Lost());
  EXPECT_EQ(report.Take(3, 1), Lost(3));
  EXPECT_EQ(report.Take(5, GST_SECOND), Lost()) << "too soon";
  EXPECT_EQ(report.Take(5, GST_SECOND + 1), Lost(2));
  EXPECT_EQ(report.Take(5, 10 * GST_SECOND), Lost()) << "told already";
}

TEST(OusterLossReport, APacketThatComesLateIsNoLoss) {
  gst::LossReport report;
  using Lost = std::optional<guint64>;
  EXPECT_EQ(report.Take(3, 0), Lost(3));
  EXPECT_EQ(report.Take(2, 2 * GST_SECOND), Lost());
  EXPECT_EQ(report.Take(4, 4 * GST_SECOND), Lost(1));
}

}  // namespace
}  // namespace lidar::test
