// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/odometry/scan_collector.h"

#include <gtest/gtest.h>

namespace lidar::gst {
namespace {

using std::chrono::milliseconds;

constexpr Time kStart{std::chrono::seconds(50)};

class Collector : public ::testing::Test {
 protected:
  /// Rows of beams, two of them where clouds are organised.
  void Prepare(guint height) {
    info_.height = height;
    info_.point_step = 12;
    info_.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8");
    info_.framerate_n = 10;
    info_.framerate_d = 1;
    ASSERT_TRUE(collector_.SetInfo(info_));
    height_ = height;
  }
  /// `width` columns whose points have their index, from 1 on, as x.
  void Add(guint scan, guint index, guint count, Time time, guint width) {
    std::vector<float> points;
    for (guint i = 0; i < width * height_; ++i)
      points.insert(points.end(), {static_cast<float>(i + 1), 0, 0});
    collector_.Add({scan, index, count, 0}, time, reinterpret_cast<const guint8*>(points.data()),
                   4 * points.size());
  }

  CloudInfo info_;
  ScanCollector collector_;
  guint height_ = 1;
};

TEST_F(Collector, TellsWhenEachColumnWasSampled) {
  Prepare(2);
  for (guint i = 0; i < 2; ++i) Add(7, i, 2, kStart + i * milliseconds(50), 4);
  EXPECT_TRUE(collector_.complete());
  const auto scan = collector_.Take();
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->start, kStart);
  EXPECT_EQ(scan->duration, milliseconds(100));
  // Four columns in each half; both rows of a column at once.
  const std::vector<float> phases = {0,   .125, .25,  .375, 0,   .125, .25,  .375,
                                     .5F, .625, .75F, .875, .5F, .625, .75F, .875};
  EXPECT_EQ(scan->points.phases, phases);
  const std::vector<std::uint16_t> rings = {0, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0, 1, 1, 1, 1};
  EXPECT_EQ(scan->points.rings, rings);
  EXPECT_EQ(scan->points.points.size(), 16U);
  EXPECT_EQ(scan->points.points[5].x(), 6);
  EXPECT_FALSE(collector_.Take());
}

TEST_F(Collector, AScanWhoseFirstSlicesAreMissingBeganBefore) {
  Prepare(2);
  Add(7, 3, 4, kStart, 4);
  EXPECT_TRUE(collector_.complete());
  EXPECT_EQ(collector_.Take()->start, kStart - milliseconds(75));
}

TEST_F(Collector, OfPointsInNoOrderOnlyTheSliceTellsTheTime) {
  Prepare(1);
  Add(7, 1, 4, kStart, 2);
  EXPECT_EQ(collector_.Take()->points.phases, (std::vector<float>{.25, .25}));
  Add(8, 0, 1, kStart, 2);
  EXPECT_TRUE(collector_.Take()->points.phases.empty());
}

TEST_F(Collector, ANewScanBeginsWithItsIdOrWithASliceThatCameAlready) {
  Prepare(2);
  EXPECT_FALSE(collector_.BeginsNewScan({7, 0, 4, 0}));  // none is open
  Add(7, 1, 4, kStart, 4);
  EXPECT_FALSE(collector_.complete());
  EXPECT_FALSE(collector_.BeginsNewScan({7, 2, 4, 0}));
  EXPECT_FALSE(collector_.BeginsNewScan({7, 3, 4, 0}));
  EXPECT_TRUE(collector_.BeginsNewScan({7, 1, 4, 0}));
  EXPECT_TRUE(collector_.BeginsNewScan({8, 2, 4, 0}));
  Add(7, 3, 4, kStart, 4);
  EXPECT_TRUE(collector_.complete());
}

TEST_F(Collector, PointsWithoutAReturnAreLeftOutWithTheirTimes) {
  Prepare(2);
  const float points[] = {0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3};
  collector_.Add({1, 0, 1, 0}, kStart, reinterpret_cast<const guint8*>(points), sizeof points);
  const auto scan = collector_.Take();
  EXPECT_EQ(scan->points.points.size(), 3U);
  EXPECT_EQ(scan->points.phases, (std::vector<float>{.5, 0, .5}));
}

TEST_F(Collector, AScanLastsAsLongAsTheFramerateSays) {
  Prepare(2);
  info_.framerate_n = 20;
  ASSERT_TRUE(collector_.SetInfo(info_));
  Add(7, 0, 1, kStart, 4);
  EXPECT_EQ(collector_.Take()->duration, milliseconds(50));
  info_.framerate_n = 0;  // not known
  ASSERT_TRUE(collector_.SetInfo(info_));
  Add(8, 0, 1, kStart, 4);
  EXPECT_EQ(collector_.Take()->duration, milliseconds(100));
}

TEST_F(Collector, FindsTheCoordinatesBehindOtherFields) {
  Prepare(1);
  info_.point_step = 20;
  info_.fields = *PointFields::Parse("t:U32:0,x:F32:4,y:F32:8,z:F32:12");
  ASSERT_TRUE(collector_.SetInfo(info_));
  const float points[] = {9, 1, 2, 3, 9, 8, 0, 5, 0, 8};
  collector_.Add({1, 0, 1, 0}, kStart, reinterpret_cast<const guint8*>(points), sizeof points);
  const auto scan = collector_.Take();
  ASSERT_EQ(scan->points.points.size(), 2U);
  EXPECT_EQ(scan->points.points[0], Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(scan->points.points[1], Eigen::Vector3d(0, 5, 0)) << "on an axis";
}

TEST_F(Collector, TheNextScanHasNothingOfTheOneBefore) {
  Prepare(2);
  Add(7, 2, 3, kStart, 4);
  EXPECT_TRUE(collector_.complete());
  collector_.Take();
  Add(8, 0, 2, kStart, 1);
  EXPECT_FALSE(collector_.complete());
  EXPECT_FALSE(collector_.BeginsNewScan({8, 1, 2, 0}));
  EXPECT_EQ(collector_.Take()->points.points.size(), 2U);
}

TEST_F(Collector, NeedsPackedCoordinates) {
  CloudInfo info;
  info.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:12");
  EXPECT_FALSE(collector_.SetInfo(info));
}

}  // namespace
}  // namespace lidar::gst
