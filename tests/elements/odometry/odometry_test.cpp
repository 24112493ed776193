// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gst/common/buffer_map.h"
#include "gst/common/pose_covariance.h"
#include "gst/lidar/gstlidar.h"
#include "tests/support/element_bus.h"
#include "tests/support/element_stats.h"
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

/// A fixture that plays a drive at 10 m/s through lidarodometry.
class Odometry : public ::testing::Test {
 protected:
  void Start(unsigned slices, unsigned scans, const std::string& properties = "") {
    Prepare(slices, scans, properties);
    gst_harness_play(h_.get());
  }
  void Prepare(unsigned slices, unsigned scans, const std::string& properties = "") {
    const std::string line =
        Format(kDrive, slices, slices * scans) + " ! lidarodometry name=o " + properties;
    h_.reset(gst_harness_new_parse(line.c_str()));
    bus_.emplace(h_->element);
    element_.reset(gst_bin_get_by_name(GST_BIN(h_->element), "o"));
  }
  std::vector<BufferPtr> PullAll(unsigned count) {
    std::vector<BufferPtr> buffers;
    for (unsigned i = 0; i < count; ++i) buffers.emplace_back(gst_harness_pull(h_.get()));
    return buffers;
  }
  StructurePtr Stats() { return test::StatsOf(element_.get()); }
  guint64 Count(const char* name) { return test::StatOf(element_.get(), name); }
  /// Waits until lidarodometry has output EOS.
  void WaitForEnd() {
    for (bool ended = false; !ended;) {
      const EventPtr event(gst_harness_pull_event(h_.get()));
      ended = !event || GST_EVENT_TYPE(event.get()) == GST_EVENT_EOS;
    }
  }
  struct Told {
    double way = 0;  // distance from the origin
    guint64 time = 0;
  };
  /// Returns the contents of the messages about scans since the last call.
  std::vector<Told> TakeMessages() {
    std::vector<Told> all;
    while (const MessagePtr message = bus_->Pop(GST_MESSAGE_ELEMENT)) {
      double x = 0;
      double y = 0;
      double z = 0;
      guint64 time = 0;
      if (gst_structure_get(gst_message_get_structure(message.get()), "x", G_TYPE_DOUBLE, &x, "y",
                            G_TYPE_DOUBLE, &y, "z", G_TYPE_DOUBLE, &z, "timestamp", G_TYPE_UINT64,
                            &time, nullptr) != FALSE)
        all.push_back({std::hypot(x, y, z), time});
    }
    return all;
  }
  unsigned CountMessages(const char* name) {
    unsigned count = 0;
    while (const MessagePtr message = bus_->Pop(GST_MESSAGE_ELEMENT))
      if (gst_message_has_name(message.get(), name)) ++count;
    return count;
  }

  Harness h_;
  std::unique_ptr<GstElement, Unref> element_;
  std::optional<test::ElementBus> bus_;
};

double Distance(const GstLidarPose& pose) {
  return std::hypot(pose.position[0], pose.position[1], pose.position[2]);
}

TEST_F(Odometry, PutsThePoseOnEveryScan) {
  Start(1, 10);
  const auto scans = PullAll(10);
  GstLidarPose first;
  GstLidarPose last;
  ASSERT_TRUE(gst_lidar_buffer_get_pose(scans.front().get(), &first));
  ASSERT_TRUE(gst_lidar_buffer_get_pose(scans.back().get(), &last));
  EXPECT_EQ(first.tracking, GST_LIDAR_TRACKING_STARTED);
  EXPECT_EQ(last.tracking, GST_LIDAR_TRACKING_OK);
  EXPECT_EQ(first.covariance[0], 0);
  EXPECT_GT(last.covariance[0], 0);
  EXPECT_LT(last.covariance[0], 1);
  EXPECT_GT(last.covariance[35], 0);
  EXPECT_LT(last.covariance[35], 0.01);
  EXPECT_NE(last.covariance[5], 0) << "a turn moves the position";
  Covariance told;
  ASSERT_TRUE(GetCovariance(Stats().get(), told.data()));
  EXPECT_TRUE(std::equal(told.begin(), told.end(), last.covariance));
  EXPECT_LT(Distance(first), 0.01);
  EXPECT_NEAR(Distance(last), 9, 0.5);
  EXPECT_EQ(Count("scans"), 10U);
  EXPECT_EQ(CountMessages("odometry"), 10U);
}

/// Returns the distance that the odometry measures over five scans at 20 m/s. The clouds pass
/// through `coder` first.
double DriveOf(const std::string& model, const char* deskew, const std::string& coder = "") {
  const Harness h(
      gst_harness_new_parse(("lidartestsrc speed=20 num-buffers=7 model=" + model + " ! " + coder +
                             "lidarodometry initial-velocity=\"20 0 0 0 0 0\" deskew=" + deskew)
                                .c_str()));
  gst_harness_play(h.get());
  GstLidarPose second{};
  GstLidarPose last{};
  for (int i = 0; i < 7; ++i) {
    const BufferPtr scan(gst_harness_pull(h.get()));
    EXPECT_TRUE(gst_lidar_buffer_get_pose(scan.get(), &last));
    if (i == 1) second = last;
  }
  for (int k = 0; k < 3; ++k) last.position[k] -= second.position[k];
  return Distance(last);
}

TEST_F(Odometry, FollowsCloudsOfDriversByTheTimesOfTheirPoints) {
  EXPECT_NEAR(DriveOf("vlp-16", "true"), 10, 0.1);
  EXPECT_NEAR(DriveOf("xt32", "true"), 10, 0.1);
  EXPECT_NEAR(DriveOf("mid-360", "true"), 10, 0.05);
  EXPECT_GT(std::abs(DriveOf("mid-360", "false") - 10), 0.1);
}

TEST_F(Odometry, FollowsCodedCloudsByTheTimesThatComeBack) {
  const std::string decoder = " ! lidardec ! ";
  EXPECT_NEAR(DriveOf("mid-360", "true", "lidarenc effort=1 fields=timestamp" + decoder), 10, 0.05);
  EXPECT_GT(std::abs(DriveOf("mid-360", "true", "lidarenc effort=1" + decoder) - 10), 0.07);
}

TEST_F(Odometry, BeginsAtItsInitialPose) {
  // In the initial pose the sensor is turned left by 90 degrees. Therefore a drive along the
  // sensor's x axis moves along y.
  Start(1, 5, "initial-pose=\"100 20 3 0 0 0.70710678 0.70710678\"");
  const auto scans = PullAll(5);
  GstLidarPose first;
  GstLidarPose last;
  ASSERT_TRUE(gst_lidar_buffer_get_pose(scans.front().get(), &first));
  ASSERT_TRUE(gst_lidar_buffer_get_pose(scans.back().get(), &last));
  EXPECT_EQ(first.tracking, GST_LIDAR_TRACKING_STARTED);
  EXPECT_NEAR(first.position[0], 100, 0.01);
  EXPECT_NEAR(first.position[1], 20, 0.01);
  EXPECT_NEAR(last.position[0], 100, 1);
  EXPECT_NEAR(last.position[1], 24, 1);
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
  for (const char* velocity : {"1 2 3", "1 2 3 0 0 nan", "1 2 3 0 0 0 1", "x", "1e300 0 0 0 0 0",
                               "0 0 -1001 0 0 0", "0 0 0 0 101 0"}) {
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
  Start(8, 9);
  const auto slices = PullAll(72);
  EXPECT_EQ(Count("scans"), 9U);
  double before = -1;
  for (unsigned i = 40; i < 72; ++i) {  // from here on the velocity is known
    GstLidarPose pose;
    ASSERT_TRUE(gst_lidar_buffer_get_pose(slices[i].get(), &pose));
    EXPECT_GT(Distance(pose), before - 0.05) << i;
    before = Distance(pose);
  }
  EXPECT_NEAR(before, 8.44, 0.2);
}

TEST_F(Odometry, AlignsAScanOfWhichSlicesAreMissing) {
  // In scan n, slice n is missing.
  constexpr unsigned kGiven = 8;
  Prepare(8, kGiven);
  const PadPtr sink(gst_element_get_static_pad(element_.get(), "sink"));
  guint slices = 0;
  gst_pad_add_probe(
      sink.get(), GST_PAD_PROBE_TYPE_BUFFER,
      [](GstPad*, GstPadProbeInfo*, gpointer count) {
        const guint i = (*static_cast<guint*>(count))++;
        return i % 8 == i / 8 ? GST_PAD_PROBE_DROP : GST_PAD_PROBE_OK;
      },
      &slices, nullptr);
  gst_harness_play(h_.get());
  PullAll(7 * kGiven);
  WaitForEnd();
  EXPECT_EQ(Count("scans"), kGiven);
  EXPECT_EQ(Count("scans-lost"), 0U);
  // The vehicle drives 1 m per scan.
  const auto told = TakeMessages();
  ASSERT_EQ(told.size(), kGiven);
  for (unsigned scan = 0; scan < kGiven; ++scan) {
    EXPECT_NEAR(told[scan].way, scan, 0.3) << scan;
    EXPECT_EQ(told[scan].time - told[0].time, scan * 100 * GST_MSECOND) << scan;
  }
}

TEST_F(Odometry, WritesTheTrajectory) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("lidarodometry-" + std::to_string(g_random_int()) + ".tum");
  Start(1, 4, "trajectory=" + path.string());
  PullAll(4);
  h_.reset();
  std::ifstream file(path);
  unsigned poses = 0;
  for (std::string line; std::getline(file, line);) ++poses;
  EXPECT_EQ(poses, 4U);
  std::filesystem::remove(path);
}

/// Stops a pipeline at the end of a test, even if the test returns early.
struct Stop {
  void operator()(GstElement* pipeline) const { gst_element_set_state(pipeline, GST_STATE_NULL); }
};

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
  const test::ElementBus bus(pipeline.get());
  const std::unique_ptr<GstElement, Stop> playing(pipeline.get());
  gst_element_set_state(pipeline.get(), GST_STATE_PLAYING);
  unsigned count = 0;
  for (GstSample* sample = nullptr;; ++count) {
    g_signal_emit_by_name(sink.get(), "pull-sample", &sample);
    if (sample == nullptr) break;
    GstBuffer* buffer = gst_sample_get_buffer(sample);
    const BufferMap map(buffer, GST_MAP_READ);
    ASSERT_EQ(map.size(), 44 * 8U);
    MessagePtr message;
    do message = bus.Wait(GST_MESSAGE_ELEMENT, GST_SECOND);
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
    Covariance covariance;
    ASSERT_TRUE(GetCovariance(told, covariance.data()));
    EXPECT_EQ(std::memcmp(map.data() + offset + 8, covariance.data(), sizeof covariance), 0);
    guint64 time = 0;
    gst_structure_get_uint64(told, "timestamp", &time);
    EXPECT_EQ(gst_lidar_buffer_get_capture_time(buffer), time);
    EXPECT_EQ(GST_BUFFER_PTS(buffer), count * 100 * GST_MSECOND);
    gst_sample_unref(sample);
  }
  EXPECT_EQ(count, 6U);
}

}  // namespace
}  // namespace lidar::gst
