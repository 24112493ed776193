// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gst/video/video.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "gst/common/buffer_map.h"
#include "gst/lidar/cloud_info.h"
#include "gst/view/trail_map.h"
#include "tests/support/element_bus.h"
#include "tests/support/harness.h"

namespace lidar::gst {
namespace {

using test::Harness;

struct Point {
  float x, y, z, intensity;
};

CloudInfo Info(guint width, guint height = 1) {
  CloudInfo info;
  info.width = width;
  info.height = height;
  info.point_step = sizeof(Point);
  info.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,intensity:F32:12");
  info.framerate_n = 10;
  return info;
}

BufferPtr Cloud(const std::vector<Point>& points) {
  return BufferPtr(gst_buffer_new_memdup(points.data(), points.size() * sizeof(Point)));
}

/// A fixture with a view of 200 x 100 pixels.
class View : public ::testing::Test {
 protected:
  void Start(const std::string& properties, const CloudInfo& info, const char* format = "RGB") {
    h_.reset(gst_harness_new_parse(("pointcloudview width=200 height=100 " + properties).c_str()));
    gst_harness_set_sink_caps_str(h_.get(), (std::string("video/x-raw,format=") + format).c_str());
    gst_harness_set_src_caps(h_.get(), info.ToCaps());
  }
  GstFlowReturn Push(BufferPtr buffer, GstClockTime pts = 0) {
    GST_BUFFER_PTS(buffer.get()) = pts;
    return gst_harness_push(h_.get(), buffer.release());
  }
  GstFlowReturn PushSlice(const std::vector<Point>& points, GstLidarSlice slice) {
    BufferPtr buffer = Cloud(points);
    gst_lidar_buffer_set_slice(buffer.get(), &slice);
    return Push(std::move(buffer), slice.scan_id * 100 * GST_MSECOND);
  }
  /// Pushes a scan, or a slice of a scan. The sensor is at `place` and is not rotated.
  GstFlowReturn PushFrom(std::array<float, 3> place, const std::vector<Point>& points, guint scan,
                         guint index = 0, guint count = 1) {
    BufferPtr buffer = Cloud(points);
    const GstLidarSlice slice{scan, index, count, 0};
    gst_lidar_buffer_set_slice(buffer.get(), &slice);
    const GstLidarPose pose{
        {place[0], place[1], place[2]}, {0, 0, 0, 1}, GST_LIDAR_TRACKING_OK, {}};
    gst_lidar_buffer_set_pose(buffer.get(), &pose);
    return Push(std::move(buffer), scan * 100 * GST_MSECOND);
  }
  void Pull() {
    frame_.reset(gst_harness_pull(h_.get()));
    ASSERT_TRUE(frame_);
    const CapsPtr caps(gst_pad_get_current_caps(h_->sinkpad));
    ASSERT_TRUE(gst_video_info_from_caps(&video_, caps.get()));
  }
  guint Waiting() { return gst_harness_buffers_in_queue(h_.get()); }
  std::array<int, 3> Pixel(int x, int y) {
    GstVideoFrame frame;
    EXPECT_TRUE(gst_video_frame_map(&frame, &video_, frame_.get(), GST_MAP_READ));
    std::array<int, 3> rgb{};
    for (guint c = 0; c < 3; ++c) {
      const auto* data = static_cast<const guint8*>(GST_VIDEO_FRAME_COMP_DATA(&frame, c));
      rgb[c] = data[y * GST_VIDEO_FRAME_COMP_STRIDE(&frame, c) +
                    x * GST_VIDEO_FRAME_COMP_PSTRIDE(&frame, c)];
    }
    gst_video_frame_unmap(&frame);
    return rgb;
  }
  /// Returns true if the pixel is bright enough for a point. The background is dark, and the
  /// brightness of range rings is in between.
  bool IsPoint(int x, int y) {
    const auto p = Pixel(x, y);
    return std::max({p[0], p[1], p[2]}) > 130;
  }

  /// Returns true if the pixel shows a point or the map. The map is darker than a point and
  /// brighter than the background.
  bool IsDrawn(int x, int y) {
    const auto p = Pixel(x, y);
    return std::max({p[0], p[1], p[2]}) > 60;
  }

  Harness h_;
  BufferPtr frame_;
  GstVideoInfo video_;
};

TEST_F(View, FromAboveAPointLiesWhereItIs) {
  Start("view=top extent=100 point-size=1", Info(2));
  ASSERT_EQ(Push(Cloud({{25, 0, 0, 1}, {0, 15, 0, 1}}), 7), GST_FLOW_OK);
  Pull();
  EXPECT_EQ(GST_VIDEO_INFO_WIDTH(&video_), 200);
  EXPECT_EQ(GST_BUFFER_PTS(frame_.get()), 7U);
  EXPECT_EQ(GST_BUFFER_DURATION(frame_.get()), 100 * GST_MSECOND);
  EXPECT_TRUE(IsPoint(150, 50));  // forward is to the right
  EXPECT_TRUE(IsPoint(100, 20));  // left is up
  EXPECT_FALSE(IsPoint(50, 50));
}

TEST_F(View, WhatIsHighHidesWhatIsLowFromAbove) {
  Start("view=top point-size=3 color-by=height color-min=0 color-max=10", Info(2));
  Push(Cloud({{25, 0, 10, 1}, {25, 0, 0, 1}}));
  Pull();
  const auto p = Pixel(150, 50);
  EXPECT_GT(p[0], p[2]);  // large values have warm colours
}

TEST_F(View, RingsLieBehindThePoints) {
  Start("view=top point-size=3 color-by=height color-min=-9 color-max=9", Info(1));
  Push(Cloud({{12.5F, 0, 0, 1}}));
  Pull();
  EXPECT_NE(Pixel(120, 50), Pixel(115, 50)) << "the ring of ten metres";
  const auto beside_a_ring = Pixel(125, 50);
  Push(Cloud({{10, 0, 0, 1}}));
  Pull();
  EXPECT_EQ(Pixel(120, 50), beside_a_ring);
}

TEST_F(View, InPerspectiveTheTargetIsInTheMiddle) {
  Start("eye-x=-10 eye-y=3 eye-z=5 target-x=20 target-y=-2 target-z=1 point-size=3", Info(2));
  Push(Cloud({{20, -2, 1, 1}, {-20, 0, 0, 1}}));
  Pull();
  EXPECT_TRUE(IsPoint(100, 50));
}

TEST_F(View, TheRangeImageHasForwardInTheMiddleAndNothingWhereNothingReturned) {
  CloudInfo info = Info(4, 2);
  info.sensor_model.emplace();
  info.sensor_model->columns_per_scan = 4;
  info.sensor_model->beams = {{0, 5, 1}, {0, -5, 0}};
  Start("view=range color-by=range", info);
  const Point hit{20, 0, 0, 1};
  const Point none{0, 0, 0, 0};
  Push(Cloud({none, hit, none, none, none, none, hit, none}));
  Pull();
  // Destaggering moves column 1 of the upper beam to column 2. The lower beam has its point in
  // column 2, too.
  for (const int x : {25, 75, 175}) EXPECT_FALSE(IsPoint(x, 25) || IsPoint(x, 75)) << x;
  EXPECT_TRUE(IsPoint(125, 25));
  EXPECT_TRUE(IsPoint(125, 75));
}

TEST_F(View, TheRangeImageOfAPlainCloudHasTheHighestPointAboveAndTheLowestBelow) {
  Start("view=range color-by=range", Info(3));
  Push(Cloud({{10, 0, 10, 1}, {0, 10, -10, 1}, {0, -10, 0, 1}}));
  Pull();
  EXPECT_TRUE(IsPoint(100, 0));
  EXPECT_TRUE(IsPoint(50, 99));
  EXPECT_TRUE(IsPoint(150, 49));
  EXPECT_FALSE(IsPoint(100, 49) || IsPoint(50, 49) || IsPoint(150, 0) || IsPoint(150, 99));
}

TEST_F(View, TheRangeImageOfASensorThatLooksUpHasNoEmptyBand) {
  Start("view=range color-by=range", Info(2));
  Push(Cloud({{10, 0, 100, 1}, {0, 10, 20, 1}}));
  Pull();
  EXPECT_TRUE(IsPoint(100, 0));
  EXPECT_TRUE(IsPoint(50, 99));
}

TEST_F(View, PixelsAreSquareWhereDownstreamLeavesThatOpen) {
  Start("", Info(1), "RGB,pixel-aspect-ratio=(fraction)[1/2,2/1]");
  Push(Cloud({{25, 0, 0, 1}}));
  Pull();
  EXPECT_EQ(GST_VIDEO_INFO_PAR_N(&video_), 1);
  EXPECT_EQ(GST_VIDEO_INFO_PAR_D(&video_), 1);
}

TEST_F(View, AScanIsOnePictureHoweverItIsCut) {
  Start("view=top point-size=1", Info(1));
  for (guint scan = 0; scan < 3; ++scan) {
    ASSERT_EQ(PushSlice({{25, 0, 0, 1}}, {scan, 0, 2, 0}), GST_FLOW_OK);
    EXPECT_EQ(Waiting(), 0U);
    ASSERT_EQ(PushSlice({{0, 15, 0, 1}}, {scan, 1, 2, 1}), GST_FLOW_OK);
    Pull();
    EXPECT_EQ(GST_BUFFER_PTS(frame_.get()), scan * 100 * GST_MSECOND);
    EXPECT_TRUE(IsPoint(150, 50) && IsPoint(100, 20));
    GstLidarSlice slice{};
    EXPECT_FALSE(gst_lidar_buffer_get_slice(frame_.get(), &slice));
  }
}

TEST_F(View, APictureIsDiscontWhereOneOfItsSlicesIs) {
  Start("view=top", Info(1));
  for (guint scan = 0; scan < 4; ++scan) {
    for (guint index = 0; index < 3; ++index) {
      BufferPtr buffer = Cloud({{25, 0, 0, 1}});
      const GstLidarSlice slice{scan, index, 3, index};
      gst_lidar_buffer_set_slice(buffer.get(), &slice);
      if (scan == 2 && index == 1) GST_BUFFER_FLAG_SET(buffer.get(), GST_BUFFER_FLAG_DISCONT);
      ASSERT_EQ(Push(std::move(buffer), scan * 100 * GST_MSECOND), GST_FLOW_OK);
    }
    Pull();
    EXPECT_EQ(GST_BUFFER_IS_DISCONT(frame_.get()), scan == 2) << scan;
  }
}

TEST_F(View, AScanWhoseLastSliceIsLostShowsWhenTheNextBegins) {
  Start("view=top point-size=1", Info(1));
  PushSlice({{25, 0, 0, 1}}, {0, 0, 2, 0});
  PushSlice({{0, 15, 0, 1}}, {1, 0, 2, 0});
  Pull();
  EXPECT_EQ(GST_BUFFER_PTS(frame_.get()), 0U);
  EXPECT_TRUE(IsPoint(150, 50));
  EXPECT_FALSE(IsPoint(100, 20));
}

TEST_F(View, EveryFormatShowsTheSameColours) {
  std::array<int, 3> expected{};
  for (const char* format : {"RGB", "BGR", "RGBx", "BGRx", "RGBA", "BGRA"}) {
    Start("view=top point-size=1", Info(1), format);
    Push(Cloud({{25, 0, 0, 1}}));
    Pull();
    if (expected[0] == 0) expected = Pixel(150, 50);
    EXPECT_EQ(Pixel(150, 50), expected) << format;
  }
}

TEST_F(View, WhatIsBrightestIsBrightInEachPicture) {
  Start("view=top point-size=1 color-by=intensity", Info(1));
  for (const float intensity : {1000.0F, 1.0F}) {
    Push(Cloud({{25, 0, 0, intensity}}));
    Pull();
    EXPECT_TRUE(IsPoint(150, 50)) << intensity;
  }
}

TEST_F(View, SettingsMayChangeWhileItPlays) {
  Start("view=top point-size=1", Info(1));
  Push(Cloud({{25, 0, 0, 1}}));
  Pull();
  GstElement* element = gst_harness_find_element(h_.get(), "pointcloudview");
  g_object_set(element, "extent", 50.0, nullptr);
  gst_object_unref(element);
  Push(Cloud({{12.5F, 0, 0, 1}}));
  Pull();
  EXPECT_TRUE(IsPoint(150, 50));
}

TEST_F(View, TheMapKeepsWhatWasSeenWhereItWas) {
  Start("map=true view=top extent=100 point-size=1", Info(2));
  for (guint scan = 0; scan < 4; ++scan) {
    // The wall is at x = 25 of the map. The sensor drives to x = 10.
    const float driven = scan < 3 ? 0.0F : 10.0F;
    const float wall = scan < 3 ? 25.0F : 500.0F;  // the last scan does not see the wall
    PushFrom({driven, 0, 0}, {{wall, 12, 0, 1}, {wall, 12.5F, 0, 1}}, scan);
    Pull();
  }
  // The centre of the picture is at x = 5, in the middle of the driven path.
  EXPECT_TRUE(IsDrawn(140, 25));
  EXPECT_FALSE(IsDrawn(160, 25));
  EXPECT_TRUE(IsDrawn(95, 50));  // the driven path
  EXPECT_FALSE(IsDrawn(80, 50));
}

/// The map stores, for each point, the value that determines its colour. Therefore a new color-max
/// needs no new map, but a new color-by does.
TEST_F(View, TheMapBeginsAnewWithOtherColoursOnly) {
  for (const auto& [property, value, stays] :
       {std::tuple("point-size", "2", true), std::tuple("color-max", "1", true),
        std::tuple("color-by", "height", false), std::tuple("map", "false", false)}) {
    Start("map=true view=top extent=100 point-size=1 color-by=intensity", Info(2));
    const ElementPtr element(gst_harness_find_element(h_.get(), "pointcloudview"));
    for (guint scan = 0; scan < 4; ++scan) {
      const float wall = scan < 3 ? 25.0F : 500.0F;
      if (scan == 3) gst_util_set_object_arg(G_OBJECT(element.get()), property, value);
      PushFrom({0, 0, 0}, {{wall, 12, 0, 1}, {wall, 12.5F, 0, 1}}, scan);
      Pull();
    }
    EXPECT_EQ(IsDrawn(150, 25), stays) << property;
  }
}

TEST_F(View, TheColumnsOfASliceLieWhereTheSensorWasInItsSweep) {
  Start("map=true view=top extent=100 point-size=1", Info(2, 2));
  const Point missing{};
  const Point aside{0.25F, 11.75F, 0, 1};
  PushFrom({0, 0, 0}, {missing, missing, missing, missing}, 0);
  Pull();
  // The sensor drives 10 m per scan of four columns, which is 2.5 m from one column to the next.
  PushFrom({10, 0, 0}, {aside, aside, missing, missing}, 1, 0, 2);
  PushFrom({10, 0, 0}, {missing, missing, missing, missing}, 1, 1, 2);
  Pull();
  EXPECT_TRUE(IsPoint(110, 26));
  EXPECT_TRUE(IsPoint(115, 26));
  EXPECT_FALSE(IsPoint(120, 26));
}

TEST_F(View, TheWholeWayIsInThePictureOfTheMap) {
  Start("map=true view=top extent=100", Info(1));
  for (guint scan = 0; scan < 5; ++scan) {
    PushFrom({400.0F * static_cast<float>(scan), 0, 0}, {{5, 5, 0, 1}}, scan);
    Pull();
  }
  EXPECT_TRUE(IsDrawn(4, 50));
  EXPECT_TRUE(IsDrawn(100, 50));
  EXPECT_TRUE(IsDrawn(195, 50));
}

TEST_F(View, TheWholeWayIsInALowPictureToo) {
  Start("map=true view=top extent=100", Info(1));
  for (guint scan = 0; scan < 5; ++scan) {
    PushFrom({0, 25.0F * static_cast<float>(scan), 0}, {{5, 5, 0, 1}}, scan);
    Pull();
  }
  EXPECT_TRUE(IsDrawn(100, 20));
  EXPECT_TRUE(IsDrawn(100, 80));
  EXPECT_FALSE(IsDrawn(100, 5));
  EXPECT_FALSE(IsDrawn(100, 95));
}

TEST_F(View, InPerspectiveTheMapReaches300MetresToEachSide) {
  const std::vector<Point> places = {
      {10, 5, 5, 1}, {290, 60, 30, 1}, {310, 96, 32, 1}, {290, 290, 30, 1}, {290, -310, 30, 1}};
  Start("map=true eye-x=-10 eye-y=0 eye-z=0 target-x=20 target-y=0 target-z=0 field-of-view=120",
        Info(5));
  // The sensor faces along the y axis of the map.
  const double half = std::sqrt(0.5);
  const GstLidarPose pose{{100, 50, 3}, {0, 0, half, half}, GST_LIDAR_TRACKING_OK, {}};
  for (guint scan = 0; scan < 4; ++scan) {
    BufferPtr cloud = Cloud(scan < 3 ? places : std::vector<Point>(5));
    gst_lidar_buffer_set_pose(cloud.get(), &pose);
    Push(std::move(cloud), scan * 100 * GST_MSECOND);
    Pull();
    if (scan == 0) {
      EXPECT_TRUE(IsPoint(85, 35));
    }
  }
  EXPECT_TRUE(IsDrawn(85, 35));
  EXPECT_TRUE(IsDrawn(88, 44));
  EXPECT_TRUE(IsDrawn(44, 44));
  EXPECT_FALSE(IsDrawn(82, 44)) << "310 m ahead";
  EXPECT_FALSE(IsDrawn(159, 44)) << "310 m aside";
}

TEST_F(View, WithoutPosesThereIsNoMapAndAWarning) {
  Start("map=true view=top extent=100 point-size=1", Info(1));
  const test::ElementBus bus(h_->element);
  for (guint scan = 0; scan < 3; ++scan) {
    PushSlice({{25, 0, 0, 1}}, {scan, 0, 1, 0});
    Pull();
    EXPECT_TRUE(IsPoint(150, 50));
  }
  EXPECT_EQ(bus.Texts(GST_MESSAGE_WARNING).size(), 1U);
  PushSlice({{0, 15, 0, 1}}, {3, 0, 1, 0});
  Pull();
  EXPECT_FALSE(IsDrawn(150, 50)) << "the map of no place";
}

TEST_F(View, ACloudWithoutReturnsOrIntensityIsAPictureToo) {
  Start("view=top point-size=1 color-by=intensity", Info(1));
  EXPECT_EQ(Push(Cloud({{0, 0, 0, 0}})), GST_FLOW_OK);
  Pull();
  CloudInfo plain = Info(1);
  plain.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8");
  Start("view=top point-size=1 color-by=intensity", plain);
  EXPECT_EQ(Push(Cloud({{25, 0, 0, 1000}})), GST_FLOW_OK);
  Pull();
  EXPECT_FALSE(IsPoint(150, 50));
}

TEST_F(View, OneBrightPointDoesNotDimThePictureNorOneDimPointBrightenIt) {
  for (const bool dim : {false, true}) {
    Start("view=top point-size=1 color-by=intensity", Info(100));
    std::vector<Point> points(100, Point{0, 15, 0, 100});
    points[98] = {25, 0, 0, dim ? 1.0F : 1e9F};
    Push(Cloud(points));
    Pull();
    EXPECT_TRUE(IsPoint(100, 20));
    EXPECT_EQ(IsPoint(150, 50), !dim);
  }
}

TEST_F(View, TheRangeImageOfASensorOfOneBeamHasItsColumns) {
  CloudInfo info = Info(4);
  info.sensor_model.emplace();
  info.sensor_model->columns_per_scan = 4;
  info.sensor_model->beams = {{0, 5, 0}};
  Start("view=range color-by=range", info);
  Push(Cloud({{0, 0, 0, 0}, {20, 0, 0, 1}, {0, 0, 0, 0}, {0, 0, 0, 0}}));
  Pull();
  EXPECT_TRUE(IsPoint(52, 2) && IsPoint(98, 97));
  EXPECT_FALSE(IsPoint(48, 50) || IsPoint(102, 50));
}

TEST_F(View, TakesPosesThatMakeNoSense) {
  for (const char* view : {"top", "perspective", "range"}) {
    Start(std::string("map=true view=") + view, Info(1));
    for (const float at : {0.0F, 3e38F, std::numeric_limits<float>::quiet_NaN()}) {
      EXPECT_EQ(PushFrom({at, at, at}, {{5, 5, 0, 1}}, at == 0 ? 0 : 1), GST_FLOW_OK);
    }
  }
}

TEST(TrailMap, IsBoundedHoweverLongTheWay) {
  TrailMap map(1000);
  GstLidarPose pose{{0, 0, 0}, {0, 0, 0, 1}, GST_LIDAR_TRACKING_OK, {}};
  for (int i = 0; i < 40'000; ++i) {
    pose.position[0] = i;
    map.MoveTo(pose, 0.1 * i);
    map.Add({static_cast<float>(i), 3, 0}, 0);
    map.EndScan();
    ASSERT_LE(map.points().size(), 1000U);
    ASSERT_LE(map.way().size(), TrailMap::kMostPlaces);
  }
  EXPECT_LT(map.points().front().at[0], 100);  // the first points are still in the map
  EXPECT_GT(map.points().back().at[0], 39'000);
  EXPECT_GT(map.way().back()[0], 39'990);
}

TEST(TrailMap, ThinsItsWayOutEvenly) {
  TrailMap map(1000);
  for (int i = 0; i < 200'000; ++i)
    map.MoveTo({{1.0 * i, 0, 0}, {0, 0, 0, 1}, GST_LIDAR_TRACKING_OK, {}}, 0.1 * i);
  float least = 1e9F;
  float most = 0;
  for (std::size_t i = 1; i < map.way().size(); ++i) {
    least = std::min(least, map.way()[i][0] - map.way()[i - 1][0]);
    most = std::max(most, map.way()[i][0] - map.way()[i - 1][0]);
  }
  EXPECT_LE(most, 4 * least);
}

TEST(TrailMap, CountsTheScansThatSawAPlaceNotTheirPoints) {
  TrailMap map(1000);
  map.MoveTo({{0, 0, 0}, {0, 0, 0, 1}, GST_LIDAR_TRACKING_OK, {}}, 0);
  for (std::uint16_t scan = 1; scan <= 2; ++scan) {
    for (int i = 0; i < 5; ++i) map.Add({3.1F, 0.1F, 0.1F}, scan == 1 ? 0.0F : 10.0F);
    map.EndScan();
    ASSERT_EQ(map.points().size(), 1U);
    EXPECT_EQ(map.points()[0].scans, scan);
  }
  EXPECT_GT(map.points()[0].value, 0);
  EXPECT_LT(map.points()[0].value, 5) << "later values may be of farther away";
}

TEST(TrailMap, KnowsAPlaceHoweverOftenItWasSeen) {
  TrailMap map(1000);
  for (int scan = 0; scan < 70'000; ++scan) {
    map.Add({3.1F, 0.1F, 0.1F}, 0);
    map.EndScan();
  }
  ASSERT_EQ(map.points().size(), 1U);
  EXPECT_EQ(map.points()[0].scans, UINT16_MAX);
}

TEST(TrailMap, AGrownCubeWasSeenAsOftenAsAnyCubeInIt) {
  TrailMap map(4);
  map.Add({0.1F, 0.1F, 0.1F}, 0);
  for (int scan = 0; scan < 3; ++scan) {
    map.EndScan();
    map.Add({0.25F, 0.1F, 0.1F}, 0);
  }
  for (const float x : {10.0F, 20.0F}) map.Add({x, 0.1F, 0.1F}, 0);
  ASSERT_EQ(map.points().size(), 3U);
  EXPECT_EQ(map.points()[0].scans, 3U);
  EXPECT_EQ(map.points()[1].scans, 1U);
}

TEST(TrailMap, FollowsTheVelocityWithinAScan) {
  TrailMap map(1000);
  const double half = std::sqrt(0.5);
  map.MoveTo({{0, 0, 0}, {0, 0, 0, 1}, GST_LIDAR_TRACKING_OK, {}}, 10.0);
  map.MoveTo({{2, 0, 0}, {0, 0, 0, 1}, GST_LIDAR_TRACKING_OK, {}}, 10.1);
  EXPECT_NEAR(map.PoseAfter(0.05).position[0], 3, 1e-5);
  map.MoveTo({{4, 0, 0}, {0, 0, half, half}, GST_LIDAR_TRACKING_OK, {}}, 20);
  const Rigid after_a_gap = map.PoseAfter(0.05);
  EXPECT_NEAR(after_a_gap.position[0], 4, 1e-5);
  EXPECT_NEAR(after_a_gap.heading(), 1.5708F, 1e-3);
  // A quaternion and its negative represent the same rotation.
  std::vector<float> headings;
  for (const double sign : {1.0, -1.0}) {
    map.MoveTo({{4, 0, 0}, {0, 0, 0, 1}, GST_LIDAR_TRACKING_OK, {}}, 30);
    map.MoveTo({{4, 0, 0}, {0, 0, sign * half, sign * half}, GST_LIDAR_TRACKING_OK, {}}, 30.1);
    headings.push_back(map.PoseAfter(0.05).heading());
  }
  EXPECT_GT(headings[0], 1.6F);
  EXPECT_NEAR(headings[0], headings[1], 1e-5);
}

TEST_F(View, DrawsNoNonsense) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInf = std::numeric_limits<float>::infinity();
  for (const char* view : {"top", "perspective", "range"}) {
    for (const char* color : {"height", "intensity", "range", "ring"}) {
      Start(std::string("view=") + view + " color-by=" + color, Info(6));
      EXPECT_EQ(Push(Cloud({{kNan, 0, 0, kNan},
                            {kInf, 1, 1, kInf},
                            {3e38F, 3e38F, 3e38F, 1},
                            {-16, 0, 9, 0},
                            {1e-30F, 0, 0, 0},
                            {0, 0, 0, 0}})),
                GST_FLOW_OK);
      Pull();
    }
  }
}

TEST_F(View, TakesMetasThatMakeNoSense) {
  for (const GstLidarSlice& slice :
       {GstLidarSlice{0, 0, 0, 0}, GstLidarSlice{1, 7, 1, 4'000'000'000},
        GstLidarSlice{2, 0, 1U << 31, 5}}) {
    Start("view=range", Info(2, 2));
    const Point hit{20, 0, 0, 1};
    EXPECT_EQ(PushSlice({hit, hit, hit, hit}, slice), GST_FLOW_OK);
  }
}

TEST_F(View, RefusesCloudsWithoutCoordinates) {
  CloudInfo info = Info(1);
  info.fields = *PointFields::Parse("range:U32:0");
  Start("", info);
  EXPECT_EQ(Push(Cloud({{1, 1, 1, 1}})), GST_FLOW_NOT_NEGOTIATED);
}

TEST_F(View, RefusesACloudOfAnotherSizeThanItsCaps) {
  Start("", Info(4));
  EXPECT_EQ(Push(Cloud({{1, 1, 1, 1}})), GST_FLOW_ERROR);
}

TEST_F(View, AFlushForgetsThePictureThatWasBegun) {
  Start("view=top point-size=1", Info(1));
  PushSlice({{25, 0, 0, 1}}, {0, 0, 2, 0});
  test::Flush(h_.get());
  PushSlice({{0, 15, 0, 1}}, {1, 0, 1, 0});
  Pull();
  EXPECT_FALSE(IsPoint(150, 50));
  EXPECT_TRUE(IsPoint(100, 20));
  EXPECT_EQ(Waiting(), 0U);
}

TEST_F(View, AnotherSizeWithinAScanForgetsThePictureThatWasBegun) {
  Start("view=top point-size=1", Info(1));
  PushSlice({{25, 0, 0, 1}}, {0, 0, 2, 0});
  gst_harness_set_sink_caps_str(h_.get(), "video/x-raw,format=RGB,width=100,height=50");
  ASSERT_EQ(PushSlice({{0, 15, 0, 1}}, {0, 1, 2, 1}), GST_FLOW_OK);
  Pull();
  EXPECT_EQ(GST_VIDEO_INFO_WIDTH(&video_), 100);
  EXPECT_FALSE(IsPoint(75, 25));
  EXPECT_TRUE(IsPoint(50, 10));
}

TEST_F(View, AnotherRateAfterALossForgetsThePictureThatWasBegun) {
  Start("view=top point-size=1", Info(1));
  PushSlice({{25, 0, 0, 1}}, {0, 0, 2, 0});
  CloudInfo info = Info(1);
  info.framerate_n = 20;
  gst_harness_set_src_caps(h_.get(), info.ToCaps());
  ASSERT_EQ(PushSlice({{0, 15, 0, 1}}, {1, 0, 1, 0}), GST_FLOW_OK);
  Pull();
  EXPECT_FALSE(IsPoint(150, 50));
  EXPECT_TRUE(IsPoint(100, 20));
}

TEST_F(View, StartsAfreshAfterAStateCycle) {
  Start("view=top point-size=1", Info(1));
  for (int cycle = 0; cycle < 3; ++cycle) {
    PushSlice({{25, 0, 0, 1}}, {0, 0, 2, 0});
    gst_element_set_state(h_->element, GST_STATE_NULL);
    gst_harness_play(h_.get());
    gst_harness_set_src_caps(h_.get(), Info(1).ToCaps());
    PushSlice({{0, 15, 0, 1}}, {5, 0, 1, 0});
    Pull();
    EXPECT_FALSE(IsPoint(150, 50));
  }
}

}  // namespace
}  // namespace lidar::gst
