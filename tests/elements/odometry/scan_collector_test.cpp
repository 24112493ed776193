// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/odometry/scan_collector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <type_traits>

namespace lidar::gst {
namespace {

using std::chrono::milliseconds;

constexpr Time kStart{std::chrono::seconds(50)};

class Collector : public ::testing::Test {
 protected:
  /// Sets the format of clouds with `height` rows. Organised clouds have two rows here, others have
  /// one.
  void Prepare(guint height) {
    info_.height = height;
    info_.point_step = 12;
    info_.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8");
    info_.framerate_n = 10;
    info_.framerate_d = 1;
    ASSERT_TRUE(collector_.SetInfo(info_));
    height_ = height;
  }
  /// Adds a slice of `width` columns. The x of each point is its index + 1.
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

TEST_F(Collector, AScanTakesNoLongerThanTheOdometrySpans) {
  Prepare(1);
  info_.framerate_n = 1;
  info_.framerate_d = G_MAXINT;
  ASSERT_TRUE(collector_.SetInfo(info_));
  Add(7, 1, 2, kStart, 4);
  const auto scan = collector_.Take();
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->duration, odometry::Odometry::kLongestGap);
  EXPECT_EQ(scan->start, kStart - odometry::Odometry::kLongestGap / 2);
}

TEST_F(Collector, TellsWhenEachColumnWasSampled) {
  Prepare(2);
  for (guint i = 0; i < 2; ++i) Add(7, i, 2, kStart + i * milliseconds(50), 4);
  EXPECT_TRUE(collector_.complete());
  const auto scan = collector_.Take();
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->start, kStart);
  EXPECT_EQ(scan->duration, milliseconds(100));
  // Each half of the scan has four columns. Both points of a column have the same time.
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

/// Returns the phases of points whose field `field` has the values `times`. The first `missing`
/// points have no return, and therefore no phase.
template <class T>
std::vector<float> PhasesWith(const char* field, const std::vector<T>& times,
                              const GstLidarSlice& slice = {7, 0, 1, 0}, std::size_t missing = 0) {
  CloudInfo info;
  info.fields.Add("x", FieldType::kF32).Add("y", FieldType::kF32).Add("z", FieldType::kF32);
  const bool is_float = std::is_floating_point_v<T>;
  info.fields.Add(field, sizeof(T) == 8 ? FieldType::kF64
                         : is_float     ? FieldType::kF32
                                        : FieldType::kU32);
  info.point_step = info.fields.MinimumStep();
  info.framerate_n = 10;
  ScanCollector collector;
  EXPECT_TRUE(collector.SetInfo(info));
  std::vector<guint8> bytes(info.point_step * times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    const float x = i < missing ? 0 : 1;
    std::memcpy(bytes.data() + i * info.point_step, &x, sizeof x);
    std::memcpy(bytes.data() + i * info.point_step + 12, &times[i], sizeof times[i]);
  }
  collector.Add(slice, kStart, bytes.data(), bytes.size());
  return collector.Take()->points.phases;
}

void ExpectQuarters(const std::vector<float>& phases) {
  ASSERT_EQ(phases.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(phases[i], 0.25 * static_cast<double>(i), 1e-5);
}

TEST(PointTimes, AreTakenAsTheDriversGiveThem) {
  // These are the fields of Ouster and Nebula [ns after the cloud's time], and of Velodyne [s
  // relative to the cloud's time, which is that of the last point].
  ExpectQuarters(PhasesWith<guint32>("t", {0, 25'000'000, 50'000'000, 75'000'000}));
  ExpectQuarters(PhasesWith<guint32>("time_stamp", {9, 25'000'009, 50'000'009, 75'000'009}));
  ExpectQuarters(PhasesWith<float>("time", {-0.075F, -0.05F, -0.025F, 0}));
  // This is the field of Livox's own messages [ns after the cloud's time].
  ExpectQuarters(PhasesWith<guint32>("offset_time", {0, 25'000'000, 50'000'000, 75'000'000}));
  // These are the fields of Hesai and RoboSense [s since 1970], of Livox [ns since 1970], and of a
  // sensor without a clock [us].
  constexpr double kNow = 1'700'000'000;
  ExpectQuarters(PhasesWith<double>("timestamp", {kNow, kNow + .025, kNow + .05, kNow + .075}));
  ExpectQuarters(PhasesWith<double>(
      "timestamp", {1e9 * kNow, 1e9 * kNow + 25e6, 1e9 * kNow + 50e6, 1e9 * kNow + 75e6}));
  ExpectQuarters(PhasesWith<double>("timestamp", {4e6, 4e6 + 25e3, 4e6 + 50e3, 4e6 + 75e3}));
}

TEST(PointRings, AreThoseOfTheFieldRingOrChannel) {
  for (const char* name : {"ring", "channel"}) {
    CloudInfo info;
    info.fields.Add("x", FieldType::kF32).Add("y", FieldType::kF32).Add("z", FieldType::kF32);
    info.fields.Add(name, FieldType::kU8);
    info.point_step = info.fields.MinimumStep();
    info.framerate_n = 10;
    ScanCollector collector;
    ASSERT_TRUE(collector.SetInfo(info));
    std::vector<guint8> bytes(2 * info.point_step, 9);
    bytes[12] = 3;
    bytes[info.point_step + 12] = 7;
    collector.Add({7, 0, 1, 0}, kStart, bytes.data(), bytes.size());
    EXPECT_EQ(collector.Take()->points.rings, (std::vector<std::uint16_t>{3, 7})) << name;
  }
}

TEST(PointTimes, OfMissingReturnsDoNotCount) {
  constexpr double kNow = 1'700'000'000;
  ExpectQuarters(PhasesWith<double>("timestamp", {0, kNow, kNow + .025, kNow + .05, kNow + .075},
                                    {7, 0, 1, 0}, 1));
}

TEST(PointTimes, CountWithinTheirSlice) {
  const auto phases =
      PhasesWith<guint32>("t", {0, 12'500'000, 25'000'000, 37'500'000}, {7, 1, 2, 0});
  ASSERT_EQ(phases.size(), 4U);
  EXPECT_NEAR(phases[0], 0.5, 1e-5);
  EXPECT_NEAR(phases[3], 0.875, 1e-5);
}

TEST(PointTimes, ThatMakeNoSweepAreLeftOut) {
  EXPECT_TRUE(PhasesWith<guint32>("t", {0, 0, 0, 0}).empty());
  EXPECT_TRUE(PhasesWith<double>("timestamp", {0, 1.7e9, 1.7e9, 1.7e9}).empty());
  EXPECT_TRUE(PhasesWith<double>("timestamp", {std::nan(""), 1e300, -1e300, 0}).empty());
  EXPECT_TRUE(PhasesWith<float>("intensity", {0, .025F, .05F, .075F}).empty());
}

TEST(PointTimes, MayGoBack) {
  const auto phases = PhasesWith<float>("time", {0.05F, 0, 0.075F, 0.025F});
  ASSERT_EQ(phases.size(), 4U);
  EXPECT_NEAR(phases[0], 0.5, 1e-5);
  EXPECT_NEAR(phases[1], 0, 1e-5);
}

TEST(Rings, OfCloudsOfOneRowComeFromTheirField) {
  for (const char* name : {"ring", "channel"}) {
    CloudInfo info;
    info.fields.Add("x", FieldType::kF32).Add("y", FieldType::kF32).Add("z", FieldType::kF32);
    info.fields.Add(name, FieldType::kU16);
    info.point_step = 14;
    ScanCollector collector;
    ASSERT_TRUE(collector.SetInfo(info));
    std::vector<guint8> bytes(28, 1);
    bytes[12] = 3;
    bytes[13] = 0;
    collector.Add({7, 0, 1, 0}, kStart, bytes.data(), bytes.size());
    EXPECT_EQ(collector.Take()->points.rings, (std::vector<std::uint16_t>{3, 0x0101}));
  }
}

TEST(Rings, AreLeftOutWhereTheirFieldHoldsNoSmallNumbers) {
  CloudInfo info;
  info.fields.Add("x", FieldType::kF32).Add("y", FieldType::kF32).Add("z", FieldType::kF32);
  info.fields.Add("ring", FieldType::kF32);
  info.point_step = 16;
  ScanCollector collector;
  ASSERT_TRUE(collector.SetInfo(info));
  const float points[] = {1, 0, 0, 3, 1, 0, 0, 1e30F};
  collector.Add({7, 0, 1, 0}, kStart, reinterpret_cast<const guint8*>(points), sizeof points);
  const auto scan = collector.Take();
  EXPECT_EQ(scan->points.points.size(), 2U);
  EXPECT_TRUE(scan->points.rings.empty());
}

TEST_F(Collector, ANewScanBeginsWithItsIdOrWithASliceThatCameAlready) {
  Prepare(2);
  EXPECT_FALSE(collector_.BeginsNewScan({7, 0, 4, 0}));  // there is no open scan
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
  info_.framerate_n = 0;  // the frame rate is unknown
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
