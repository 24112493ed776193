// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of lidarodometry with clouds that no sensor sends.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "gst/lidar/gstlidar.h"
#include "tests/support/element_bus.h"
#include "tests/support/element_stats.h"
#include "tests/support/harness.h"

namespace lidar::gst {
namespace {

using test::Harness;

class OddClouds : public ::testing::Test {
 protected:
  void Start(const char* caps) {
    h_.reset(gst_harness_new("lidarodometry"));
    bus_.emplace(h_->element);
    gst_harness_set_src_caps_str(h_.get(), caps);
  }
  static GstBuffer* Points(const std::vector<float>& points, GstClockTime pts) {
    GstBuffer* buffer = gst_buffer_new_allocate(nullptr, points.size() * sizeof(float), nullptr);
    gst_buffer_fill(buffer, 0, points.data(), points.size() * sizeof(float));
    GST_BUFFER_PTS(buffer) = pts;
    return buffer;
  }
  GstFlowReturn Push(const std::vector<float>& points, GstClockTime pts) {
    return gst_harness_push(h_.get(), Points(points, pts));
  }
  /// Returns the points of a floor and two walls.
  static std::vector<float> Corner() {
    std::vector<float> corner;
    for (int a = -20; a < 20; ++a) {
      for (int b = -20; b < 20; ++b) {
        const float u = 0.5F * static_cast<float>(a);
        const float v = 0.5F * static_cast<float>(b);
        corner.insert(corner.end(), {u, v, -2, u, 10, v, 10, u, v});
      }
    }
    return corner;
  }
  guint64 Count(const char* name) { return test::StatOf(h_->element, name); }
  /// Returns the number of warnings since the last call.
  std::size_t CountWarnings() { return bus_->Texts(GST_MESSAGE_WARNING).size(); }
  /// Returns the timestamp of the last pose message, or GST_CLOCK_TIME_NONE if there is no message.
  GstClockTime TimeOfMessage() {
    GstClockTime time = GST_CLOCK_TIME_NONE;
    while (const MessagePtr message = bus_->Pop(GST_MESSAGE_ELEMENT))
      gst_structure_get_uint64(gst_message_get_structure(message.get()), "timestamp", &time);
    return time;
  }
  bool HasError() { return bus_->Pop(GST_MESSAGE_ERROR) != nullptr; }
  static constexpr const char* kXyz =
      "application/x-pointcloud2,width=0,height=1,point-step=12,"
      "fields=(string)\"x:F32:0,y:F32:4,z:F32:8\",framerate=10/1";
  Harness h_;
  std::optional<test::ElementBus> bus_;
};

TEST_F(OddClouds, MayBeEmptyOrNotFinite) {
  Start(kXyz);
  EXPECT_EQ(Push({}, 0), GST_FLOW_OK);
  EXPECT_EQ(Push({NAN, 1, 2, INFINITY, 0, 0}, GST_SECOND), GST_FLOW_OK);
  EXPECT_EQ(Push({1, 2}, 2 * GST_SECOND), GST_FLOW_OK);  // fewer bytes than a point has
  EXPECT_EQ(Push({3e38F, 3e38F, 3e38F}, 3 * GST_SECOND), GST_FLOW_OK);
  EXPECT_FALSE(HasError());
}

TEST_F(OddClouds, AreCountedWhereTheyAreWholePoints) {
  Start(kXyz);
  Push({1, 2}, 0);
  EXPECT_EQ(Count("scans"), 0U);
  Push({1, 2, 3}, GST_SECOND);
  EXPECT_EQ(Count("scans"), 1U);
  gst_element_set_state(h_->element, GST_STATE_READY);
  gst_element_set_state(h_->element, GST_STATE_PLAYING);
  EXPECT_EQ(Count("scans"), 0U);
}

TEST_F(OddClouds, WereSampledAtTheirCaptureTimes) {
  Start(kXyz);
  GstBuffer* buffer = Points({1, 2, 3}, 0);
  gst_lidar_buffer_set_capture_time(buffer, 1000 * GST_SECOND);
  gst_harness_push(h_.get(), buffer);
  EXPECT_EQ(TimeOfMessage(), 1000 * GST_SECOND + 50 * GST_MSECOND) << "the middle of the scan";
  Push({1, 2, 3}, 1001 * GST_SECOND);
  EXPECT_EQ(TimeOfMessage(), 1001 * GST_SECOND + 50 * GST_MSECOND);
  g_object_set(h_->element, "post-messages", FALSE, nullptr);
  Push({1, 2, 3}, 1002 * GST_SECOND);
  EXPECT_EQ(TimeOfMessage(), GST_CLOCK_TIME_NONE);
}

TEST_F(OddClouds, AScanThatIsCutOffEndsWithTheStreamOrItsCapsAndNotWithAFlush) {
  const auto push = [this](guint scan, guint index) {
    GstBuffer* buffer = Points({1, 2, 3}, scan * GST_SECOND);
    const GstLidarSlice slice{scan, index, 3, 0};
    gst_lidar_buffer_set_slice(buffer, &slice);
    gst_harness_push(h_.get(), buffer);
  };
  Start(kXyz);
  push(1, 0);
  push(2, 0);
  EXPECT_EQ(Count("scans"), 1U) << "the next one began";
  test::Flush(h_.get());
  push(3, 0);
  EXPECT_EQ(Count("scans"), 1U) << "nobody wants the one before the flush";
  gst_harness_set_src_caps_str(h_.get(), (std::string(kXyz) + ",is-dense=true").c_str());
  EXPECT_EQ(Count("scans"), 2U);
  push(4, 1);
  gst_harness_push_event(h_.get(), gst_event_new_eos());
  EXPECT_EQ(Count("scans"), 3U);
}

TEST_F(OddClouds, ThatFitNothingAreLostUntilAnotherMapBegins) {
  Start(kXyz);
  GstClockTime time = 0;
  const auto push = [&](const std::vector<float>& points) {
    Push(points, time += 100 * GST_MSECOND);
  };
  const std::vector<float> corner = Corner();
  const std::vector<float> elsewhere = {50, 2, 3};
  for (int i = 0; i < 4; ++i) push(corner);
  EXPECT_EQ(Count("scans-lost"), 0U);
  for (int i = 0; i < 9; ++i) push(elsewhere);
  EXPECT_EQ(Count("scans-lost"), 9U);
  EXPECT_EQ(Count("maps"), 1U);
  EXPECT_EQ(CountWarnings(), 1U);
  push(elsewhere);
  EXPECT_EQ(Count("scans-lost"), 10U);
  EXPECT_EQ(Count("maps"), 2U);
  push(elsewhere);
  EXPECT_EQ(Count("maps"), 2U) << "it fits the new map";
  push(corner);
  EXPECT_EQ(Count("maps"), 3U) << "a map that one scan has fitted is not held on to";
  EXPECT_EQ(Count("scans-lost"), 10U);
  EXPECT_EQ(CountWarnings(), 0U);
}

TEST_F(OddClouds, EachLossOfThePositionIsWarnedOfOnce) {
  Start(kXyz);
  GstClockTime time = 0;
  const auto push = [&](const std::vector<float>& points, int scans) {
    for (int i = 0; i < scans; ++i) Push(points, time += 100 * GST_MSECOND);
  };
  const std::vector<float> elsewhere = {50, 2, 3};
  push(Corner(), 4);
  for (guint64 loss = 1; loss <= 3; ++loss) {
    push(elsewhere, 2);
    EXPECT_EQ(CountWarnings(), 1U) << loss;
    push(Corner(), 2);
    EXPECT_EQ(CountWarnings(), 0U) << loss;
    EXPECT_EQ(Count("scans-lost"), 2 * loss);
  }
  EXPECT_EQ(Count("maps"), 1U);
}

TEST_F(OddClouds, OfOnePlaneDoNotShowTheMotionAlongIt) {
  Start(kXyz);
  std::vector<float> plane;
  for (int x = -20; x < 20; ++x)
    for (int y = -20; y < 20; ++y)
      plane.insert(plane.end(), {0.3F * static_cast<float>(x), 0.3F * static_cast<float>(y), -2});
  for (guint64 i = 0; i < 3; ++i) Push(plane, i * 100 * GST_MSECOND);
  EXPECT_EQ(Count("scans-degenerate"), 2U);
  EXPECT_EQ(Count("scans-lost"), 0U);
}

TEST_F(OddClouds, GoOnWhereTheTrajectoryCannotBeWritten) {
  h_.reset(gst_harness_new("lidarodometry"));
  g_object_set(h_->element, "trajectory", "/dev/full", nullptr);
  gst_element_set_state(h_->element, GST_STATE_READY);
  gst_element_set_state(h_->element, GST_STATE_PLAYING);
  bus_.emplace(h_->element);
  gst_harness_set_src_caps_str(h_.get(), kXyz);
  for (guint64 i = 0; i < 5; ++i) EXPECT_EQ(Push({1, 2, 3}, i * 100 * GST_MSECOND), GST_FLOW_OK);
  EXPECT_EQ(CountWarnings(), 1U);
}

TEST_F(OddClouds, MayHaveSlicesWithoutEnd) {
  Start(kXyz);
  const std::vector<float> points(3 << 20, 2);
  for (guint i = 0; i < 5; ++i) {
    GstBuffer* buffer = gst_buffer_new_memdup(points.data(), points.size() * sizeof(float));
    const GstLidarSlice slice{7, i, 65535, 0};
    gst_lidar_buffer_set_slice(buffer, &slice);
    GST_BUFFER_PTS(buffer) = i * GST_MSECOND;
    ASSERT_EQ(gst_harness_push(h_.get(), buffer), GST_FLOW_OK);
    gst_buffer_unref(gst_harness_pull(h_.get()));
  }
  // The first four slices count as one scan, because they have too many points.
  EXPECT_EQ(Count("scans"), 1U);
}

TEST_F(OddClouds, CutOffByTheNextScanOrTheEndHaveTheirOwnTimestamp) {
  Start(kXyz);
  const Harness poses(gst_harness_new_with_element(h_->element, nullptr, "odometry"));
  for (guint scan = 0; scan < 2; ++scan) {
    GstBuffer* buffer = Points({1, 2, 3}, scan * 100 * GST_MSECOND);
    const GstLidarSlice slice{scan, 0, 2, 0};
    gst_lidar_buffer_set_slice(buffer, &slice);
    ASSERT_EQ(gst_harness_push(h_.get(), buffer), GST_FLOW_OK);
  }
  gst_harness_push_event(h_.get(), gst_event_new_eos());
  for (guint scan = 0; scan < 2; ++scan) {
    const BufferPtr pose(gst_harness_try_pull(poses.get()));
    ASSERT_TRUE(pose) << scan;
    EXPECT_EQ(GST_BUFFER_PTS(pose.get()), scan * 100 * GST_MSECOND);
  }
}

TEST_F(OddClouds, MayBeSlicesOfNoScan) {
  Start(kXyz);
  GstBuffer* buffer = Points({1, 2, 3}, 0);
  const GstLidarSlice slice{7, 3, 0, 0};
  gst_lidar_buffer_set_slice(buffer, &slice);
  EXPECT_EQ(gst_harness_push(h_.get(), buffer), GST_FLOW_OK);
  EXPECT_EQ(Count("scans"), 1U) << "as one without a meta";
}

TEST_F(OddClouds, NeedTimestamps) {
  Start(kXyz);
  EXPECT_EQ(Push({1, 2, 3}, GST_CLOCK_TIME_NONE), GST_FLOW_ERROR);
  EXPECT_TRUE(HasError());
}

TEST_F(OddClouds, NeedPackedCoordinates) {
  constexpr const char* kDoubles =
      "application/x-pointcloud2,width=1,height=1,point-step=24,"
      "fields=(string)\"x:F64:0,y:F64:8,z:F64:16\",framerate=10/1";
  Start(kDoubles);
  for (const GstClockTime t : {1U, 3U}) {
    EXPECT_NE(Push({1, 2, 3, 4, 5, 6}, t * GST_SECOND), GST_FLOW_OK);
    EXPECT_EQ(bus_->Texts(GST_MESSAGE_ERROR).size(), 1U) << "again, after good ones";
    gst_harness_set_src_caps_str(h_.get(), kXyz);
    EXPECT_EQ(Push({1, 2, 3}, (t + 1) * GST_SECOND), GST_FLOW_OK);
    gst_harness_set_src_caps_str(h_.get(), kDoubles);
  }
}

TEST_F(OddClouds, MayGoBackInTime) {
  Start(kXyz);
  for (const GstClockTime t : {5U, 4U, 3U, 100U, 0U})
    EXPECT_EQ(Push({1, 2, 3, 4, 5, 6}, t * GST_SECOND), GST_FLOW_OK);
}

}  // namespace
}  // namespace lidar::gst
