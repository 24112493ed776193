// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "gst/common/buffer_map.h"
#include "gst/common/gstlidar.h"
#include "tests/support/harness.h"

namespace lidar::gst {
namespace {

using test::Harness;

constexpr const char* kDrive =
    "lidartestsrc model=os0-32 mode=512x10 speed=10 slices-per-scan=%u num-buffers=%u";

std::string Format(const char* format, unsigned a, unsigned b) {
  char text[200];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

/// A drive of 10 m/s through lidarodometry, until its end.
class Odometry : public ::testing::Test {
 protected:
  void Start(unsigned slices, unsigned scans, const std::string& properties = "") {
    const std::string line =
        Format(kDrive, slices, slices * scans) + " ! lidarodometry name=o " + properties;
    h_.reset(gst_harness_new_parse(line.c_str()));
    bus_ = gst_bus_new();
    gst_element_set_bus(h_->element, bus_);
    gst_harness_play(h_.get());
    element_.reset(gst_bin_get_by_name(GST_BIN(h_->element), "o"));
  }
  void TearDown() override {
    element_.reset();
    h_.reset();
    if (bus_ != nullptr) gst_object_unref(bus_);
  }
  std::vector<BufferPtr> PullAll(unsigned count) {
    std::vector<BufferPtr> buffers;
    for (unsigned i = 0; i < count; ++i) buffers.emplace_back(gst_harness_pull(h_.get()));
    return buffers;
  }
  StructurePtr Stats() {
    GstStructure* stats = nullptr;
    g_object_get(element_.get(), "stats", &stats, nullptr);
    return StructurePtr(stats);
  }
  guint64 Count(const char* name) {
    guint64 value = 0;
    gst_structure_get_uint64(Stats().get(), name, &value);
    return value;
  }
  unsigned CountMessages(const char* name) {
    unsigned count = 0;
    while (GstMessage* raw = gst_bus_pop_filtered(bus_, GST_MESSAGE_ELEMENT)) {
      const MessagePtr message(raw);
      if (gst_structure_has_name(gst_message_get_structure(raw), name)) ++count;
    }
    return count;
  }

  Harness h_;
  std::unique_ptr<GstElement, Unref> element_;
  GstBus* bus_ = nullptr;
};

double Distance(const GstLidarPose& pose) {
  return std::hypot(pose.position[0], pose.position[1], pose.position[2]);
}

TEST_F(Odometry, PutsThePoseOnEveryScan) {
  Start(1, 20);
  const auto scans = PullAll(20);
  GstLidarPose first;
  GstLidarPose last;
  ASSERT_TRUE(gst_lidar_buffer_get_pose(scans.front().get(), &first));
  ASSERT_TRUE(gst_lidar_buffer_get_pose(scans.back().get(), &last));
  EXPECT_EQ(first.tracking, GST_LIDAR_TRACKING_STARTED);
  EXPECT_EQ(last.tracking, GST_LIDAR_TRACKING_OK);
  EXPECT_LT(Distance(first), 0.01);
  EXPECT_NEAR(Distance(last), 19, 1);
  EXPECT_EQ(Count("scans"), 20U);
  EXPECT_EQ(CountMessages("odometry"), 20U);
}

TEST_F(Odometry, BeginsAtItsInitialPose) {
  // A quarter turn to the left: who drives along x goes along y.
  Start(1, 10, "initial-pose=\"100 20 3 0 0 0.70710678 0.70710678\"");
  const auto scans = PullAll(10);
  GstLidarPose first;
  GstLidarPose last;
  ASSERT_TRUE(gst_lidar_buffer_get_pose(scans.front().get(), &first));
  ASSERT_TRUE(gst_lidar_buffer_get_pose(scans.back().get(), &last));
  EXPECT_EQ(first.tracking, GST_LIDAR_TRACKING_STARTED);
  EXPECT_NEAR(first.position[0], 100, 0.01);
  EXPECT_NEAR(first.position[1], 20, 0.01);
  EXPECT_NEAR(last.position[0], 100, 1);
  EXPECT_NEAR(last.position[1], 29, 1);
  EXPECT_NEAR(last.position[2], 3, 1);
}

TEST_F(Odometry, RefusesAnInitialPoseThatIsNone) {
  for (const char* pose : {"1 2 3", "1 2 3 0 0 0 0", "1 2 3 0 0 0 nan", "1 2 3 0 0 0 1 9", "x"}) {
    const ElementPtr element(
        GST_ELEMENT(gst_object_ref_sink(gst_element_factory_make("lidarodometry", nullptr))));
    g_object_set(element.get(), "initial-pose", pose, nullptr);
    EXPECT_EQ(gst_element_set_state(element.get(), GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE)
        << pose;
    gst_element_set_state(element.get(), GST_STATE_NULL);
  }
}

TEST_F(Odometry, RefusesAnInitialVelocityThatIsNone) {
  for (const char* velocity : {"1 2 3", "1 2 3 0 0 nan", "1 2 3 0 0 0 1", "x"}) {
    const ElementPtr element(
        GST_ELEMENT(gst_object_ref_sink(gst_element_factory_make("lidarodometry", nullptr))));
    g_object_set(element.get(), "initial-velocity", velocity, nullptr);
    EXPECT_EQ(gst_element_set_state(element.get(), GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE)
        << velocity;
    gst_element_set_state(element.get(), GST_STATE_NULL);
  }
  Start(1, 2, "initial-velocity=\"10 0 0 0 0 0\"");
  EXPECT_EQ(PullAll(2).size(), 2U);
}

TEST_F(Odometry, LeavesTheCloudsAsTheyAre) {
  Harness plain(gst_harness_new_parse(Format(kDrive, 1, 2).c_str()));
  gst_harness_play(plain.get());
  Start(1, 2);
  for (int i = 0; i < 2; ++i) {
    const BufferPtr before(gst_harness_pull(plain.get()));
    const BufferPtr after(gst_harness_pull(h_.get()));
    const BufferMap a(before.get(), GST_MAP_READ);
    const BufferMap b(after.get(), GST_MAP_READ);
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size()), 0);
    EXPECT_EQ(GST_BUFFER_PTS(before.get()), GST_BUFFER_PTS(after.get()));
  }
}

TEST_F(Odometry, PredictsThePoseOfEachSlice) {
  Start(8, 12);
  const auto slices = PullAll(96);
  EXPECT_EQ(Count("scans"), 12U);
  double before = -1;
  for (unsigned i = 40; i < 96; ++i) {  // the velocity is known by then
    GstLidarPose pose;
    ASSERT_TRUE(gst_lidar_buffer_get_pose(slices[i].get(), &pose));
    EXPECT_GT(Distance(pose), before - 0.05) << i;
    before = Distance(pose);
  }
  EXPECT_NEAR(before, 11.9, 1);
}

TEST_F(Odometry, AlignsAScanOfWhichSlicesAreMissing) {
  Start(8, 12, "! identity drop-probability=0.2");
  // What came before identity is aligned; what it lets through does not matter.
  for (int i = 0; i < 60; ++i) BufferPtr(gst_harness_pull(h_.get()));
  EXPECT_GT(Count("scans"), 6U);
  EXPECT_EQ(Count("scans-lost"), 0U);
}

TEST_F(Odometry, WritesTheTrajectory) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("lidarodometry-" + std::to_string(g_random_int()) + ".tum");
  Start(1, 10, "trajectory=" + path.string());
  PullAll(10);
  h_.reset();
  std::ifstream file(path);
  unsigned poses = 0;
  for (std::string line; std::getline(file, line);) ++poses;
  EXPECT_EQ(poses, 10U);
  std::filesystem::remove(path);
}

TEST(OdometryPads, GiveThePoseOfEachScanThatItsMessageTells) {
  GError* raw = nullptr;
  const ElementPtr pipeline(gst_parse_launch(
      (Format(kDrive, 1, 6) +
       " ! lidarodometry name=o initial-pose=\"9 8 7 0 0 0.6 0.8\" ! queue ! fakesink "
       "o.odometry ! queue ! appsink name=poses sync=false")
          .c_str(),
      &raw));
  ASSERT_EQ(raw, nullptr);
  const ElementPtr sink(gst_bin_get_by_name(GST_BIN(pipeline.get()), "poses"));
  GstBus* bus = gst_element_get_bus(pipeline.get());
  gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  unsigned count = 0;
  for (GstSample* sample = nullptr;; ++count) {
    g_signal_emit_by_name(sink.get(), "pull-sample", &sample);
    if (sample == nullptr) break;
    GstBuffer* buffer = gst_sample_get_buffer(sample);
    const BufferMap map(buffer, GST_MAP_READ);
    ASSERT_EQ(map.size(), 64U);
    MessagePtr message;
    do message.reset(gst_bus_timed_pop_filtered(bus, GST_SECOND, GST_MESSAGE_ELEMENT));
    while (message && !gst_message_has_name(message.get(), "odometry"));
    ASSERT_TRUE(message);
    const GstStructure* told = gst_message_get_structure(message.get());
    std::size_t offset = 0;
    for (const char* field : {"x", "y", "z", "qx", "qy", "qz", "qw"}) {
      gdouble value = 0, expected = 0;
      std::memcpy(&value, map.data() + offset, sizeof value);
      ASSERT_TRUE(gst_structure_get_double(told, field, &expected));
      EXPECT_EQ(value, expected) << field;
      offset += sizeof value;
    }
    EXPECT_EQ(map.data()[offset], count == 0 ? GST_LIDAR_TRACKING_STARTED : GST_LIDAR_TRACKING_OK);
    guint64 time = 0;
    gst_structure_get_uint64(told, "timestamp", &time);
    EXPECT_EQ(gst_lidar_buffer_get_capture_time(buffer), time);
    EXPECT_EQ(GST_BUFFER_PTS(buffer), count * 100 * GST_MSECOND);
    gst_sample_unref(sample);
  }
  EXPECT_EQ(count, 6U);
  gst_element_set_state(pipeline.get(), GST_STATE_NULL);
  gst_object_unref(bus);
}

/// Clouds made by hand.
class OddClouds : public ::testing::Test {
 protected:
  void Start(const char* caps) {
    h_.reset(gst_harness_new("lidarodometry"));
    bus_ = gst_bus_new();
    gst_element_set_bus(h_->element, bus_);
    gst_harness_set_src_caps_str(h_.get(), caps);
  }
  void TearDown() override {
    h_.reset();
    gst_object_unref(bus_);
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
  guint64 Count(const char* name) {
    GstStructure* stats = nullptr;
    g_object_get(h_->element, "stats", &stats, nullptr);
    const StructurePtr owned(stats);
    guint64 value = G_MAXUINT64;
    gst_structure_get_uint64(stats, name, &value);
    return value;
  }
  /// Since the last call.
  int CountWarnings() {
    int count = 0;
    while (const MessagePtr message{gst_bus_pop_filtered(bus_, GST_MESSAGE_WARNING)}) ++count;
    return count;
  }
  /// That of the last pose; none where there is no message.
  GstClockTime TimeOfMessage() {
    GstClockTime time = GST_CLOCK_TIME_NONE;
    while (const MessagePtr message{gst_bus_pop_filtered(bus_, GST_MESSAGE_ELEMENT)})
      gst_structure_get_uint64(gst_message_get_structure(message.get()), "timestamp", &time);
    return time;
  }
  bool HasError() {
    const MessagePtr message(gst_bus_pop_filtered(bus_, GST_MESSAGE_ERROR));
    return message != nullptr;
  }
  static constexpr const char* kXyz =
      "application/x-pointcloud2,width=0,height=1,point-step=12,"
      "fields=(string)\"x:F32:0,y:F32:4,z:F32:8\",framerate=10/1";
  Harness h_;
  GstBus* bus_ = nullptr;
};

TEST_F(OddClouds, MayBeEmptyOrNotFinite) {
  Start(kXyz);
  EXPECT_EQ(Push({}, 0), GST_FLOW_OK);
  EXPECT_EQ(Push({NAN, 1, 2, INFINITY, 0, 0}, GST_SECOND), GST_FLOW_OK);
  EXPECT_EQ(Push({1, 2}, 2 * GST_SECOND), GST_FLOW_OK);  // no whole point
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
  gst_harness_push_event(h_.get(), gst_event_new_flush_start());
  gst_harness_push_event(h_.get(), gst_event_new_flush_stop(TRUE));
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  gst_harness_push_event(h_.get(), gst_event_new_segment(&segment));
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
  const auto push = [&](float x) { Push({x, 2, 3}, time += 100 * GST_MSECOND); };
  push(1);
  for (int i = 0; i < 9; ++i) push(50);
  EXPECT_EQ(Count("scans-lost"), 9U);
  EXPECT_EQ(Count("maps"), 1U);
  EXPECT_EQ(CountWarnings(), 1);
  push(50);
  EXPECT_EQ(Count("maps"), 2U);
  push(50);
  EXPECT_EQ(Count("scans-lost"), 10U);
  EXPECT_EQ(CountWarnings(), 0);
  push(1);
  EXPECT_EQ(CountWarnings(), 1) << "it was found in between";
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
  bus_ = gst_bus_new();
  gst_element_set_bus(h_->element, bus_);
  gst_harness_set_src_caps_str(h_.get(), kXyz);
  for (guint64 i = 0; i < 5; ++i) EXPECT_EQ(Push({1, 2, 3}, i * 100 * GST_MSECOND), GST_FLOW_OK);
  EXPECT_EQ(CountWarnings(), 1);
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
  EXPECT_EQ(Count("scans"), 1U);  // the first four, as soon as they were too many
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
  Start(
      "application/x-pointcloud2,width=1,height=1,point-step=24,"
      "fields=(string)\"x:F64:0,y:F64:8,z:F64:16\",framerate=10/1");
  EXPECT_NE(Push({1, 2, 3, 4, 5, 6}, 0), GST_FLOW_OK);
  EXPECT_TRUE(HasError());
}

TEST_F(OddClouds, MayGoBackInTime) {
  Start(kXyz);
  for (const GstClockTime t : {5U, 4U, 3U, 100U, 0U})
    EXPECT_EQ(Push({1, 2, 3, 4, 5, 6}, t * GST_SECOND), GST_FLOW_OK);
}

}  // namespace
}  // namespace lidar::gst
