// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of loop closure: its thread, and how lidarodometry uses its results.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "ext/odometry/loop_thread.h"
#include "gst/common/buffer_map.h"
#include "gst/lidar/gstlidar.h"
#include "src/cdr/motion_samples.h"
#include "tests/support/block_drive.h"
#include "tests/support/element_bus.h"
#include "tests/support/element_stats.h"
#include "tests/support/harness.h"

namespace lidar::gst {
namespace {

using test::Harness;
namespace block = test::block;

TEST(LoopThread, HasTheDriftOfALapWhenItFinishes) {
  const block::Points world = block::MakeWorld();
  const odometry::Trajectory drifted = block::Drive(block::kScansOfALap + 30);
  LoopThread loops({});
  for (std::size_t i = 0; i < drifted.size(); ++i) {
    const int scan = static_cast<int>(i);
    loops.AddScan(drifted[i], block::SeenFrom(block::TrueAt(scan), world, scan));
    if (i % 50 == 0) loops.Finish();  // waits, so that no scan is dropped
  }
  loops.Finish();
  const LoopThread::Progress progress = loops.progress();
  EXPECT_EQ(progress.scans_dropped, 0U);
  EXPECT_GE(progress.loops, 1U);
  EXPECT_GE(progress.solved, 1U);
  odometry::Trajectory corrected = drifted;
  corrected.back().pose = progress.map_from_odometry * drifted.back().pose;
  EXPECT_LT(block::EndError(corrected), block::EndError(drifted) / 5);
}

TEST(LoopThread, MayEndWithScansThatWait) {
  const block::Points world = block::MakeWorld();
  LoopThread loops({});
  for (const odometry::StampedPose& pose : block::Drive(300)) loops.AddScan(pose, world);
}

TEST(LoopThread, CountsTheScansThatItDrops) {
  const block::Points world = block::MakeWorld();
  const odometry::Trajectory way = block::Drive(300);
  LoopThread loops({});
  constexpr int kMostRounds = 100;  // more rounds than any machine can process in time
  for (int round = 0; round < kMostRounds && loops.progress().scans_dropped == 0; ++round)
    for (const odometry::StampedPose& pose : way) loops.AddScan(pose, world);
  EXPECT_GT(loops.progress().scans_dropped, 0U);
}

/// A fixture that plays a drive through lidarodometry and receives the poses of the map.
class MapPad : public ::testing::Test {
 protected:
  void Play(unsigned scans, const std::string& properties) {
    pipeline_.reset(
        gst_parse_launch(("lidartestsrc model=os0-32 mode=512x10 speed=20 slices-per-scan=1 "
                          "num-buffers=" +
                          std::to_string(scans) + " ! lidarodometry name=o " + properties +
                          " ! fakesink o.map ! queue ! appsink name=map sync=false")
                             .c_str(),
                         nullptr));
    ASSERT_TRUE(pipeline_);
    const ElementPtr sink(gst_bin_get_by_name(GST_BIN(pipeline_.get()), "map"));
    gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING);
    for (GstSample* sample = nullptr;; ++poses_) {
      g_signal_emit_by_name(sink.get(), "pull-sample", &sample);
      if (sample == nullptr) break;
      const BufferMap map(gst_sample_get_buffer(sample), GST_MAP_READ);
      std::uint64_t tracking = 0;
      const auto pose = cdr::ReadPose(map.view(), &tracking);
      ASSERT_TRUE(pose);
      last_ = *pose;
      caps_.reset(gst_caps_ref(gst_sample_get_caps(sample)));
      gst_sample_unref(sample);
    }
    const ElementPtr odometry(gst_bin_get_by_name(GST_BIN(pipeline_.get()), "o"));
    local_maps_ = test::StatOf(odometry.get(), "local-maps");
  }
  void TearDown() override {
    if (pipeline_) gst_element_set_state(pipeline_.get(), GST_STATE_NULL);
  }

  ElementPtr pipeline_;
  CapsPtr caps_;
  cdr::Odometry last_;
  unsigned poses_ = 0;
  guint64 local_maps_ = 0;
};

TEST_F(MapPad, SaysWhereTheOdometryIsInTheMapAsRosHasIt) {
  Play(26, "local-maps=10");
  EXPECT_EQ(poses_, 27U);  // one per scan, and one at EOS after the last loops
  const GstStructure* s = gst_caps_get_structure(caps_.get(), 0);
  EXPECT_STREQ(gst_structure_get_string(s, "frame-id"), "map");
  EXPECT_STREQ(gst_structure_get_string(s, "child-frame-id"), "odom");
  EXPECT_EQ(local_maps_, 2U);
  EXPECT_NEAR(last_.orientation[3], 1, 1e-9);  // the drive has no loop
  EXPECT_NEAR(last_.position[0], 0, 1e-9);
}

TEST_F(MapPad, IsTheOdometryWhereLoopsAreNotClosed) {
  Play(5, "");
  EXPECT_EQ(poses_, 5U);
  EXPECT_EQ(local_maps_, 0U);
  EXPECT_EQ(last_.orientation[3], 1);
}

constexpr const char* kCaps =
    "application/x-pointcloud2,width=1,height=1,point-step=12,"
    "fields=(string)\"x:F32:0,y:F32:4,z:F32:8\",framerate=10/1";

TEST(LateMapPad, HasTheEventsOfTheStreamAndItsOwnCaps) {
  const Harness h(gst_harness_new("lidarodometry"));
  gst_harness_set_src_caps_str(h.get(), kCaps);
  const std::array<float, 3> point = {1, 2, 3};
  const auto push = [&](GstClockTime pts) {
    GstBuffer* cloud = gst_buffer_new_memdup(point.data(), sizeof point);
    GST_BUFFER_PTS(cloud) = pts;
    EXPECT_EQ(gst_harness_push(h.get(), cloud), GST_FLOW_OK);
  };
  push(0);
  const Harness map(gst_harness_new_with_element(h->element, nullptr, "map"));
  push(100 * GST_MSECOND);
  const CapsPtr caps(gst_pad_get_current_caps(map->sinkpad));
  ASSERT_TRUE(caps);
  const GstStructure* s = gst_caps_get_structure(caps.get(), 0);
  EXPECT_STREQ(gst_structure_get_string(s, "frame-id"), "map");
  for (const GstEventType type : {GST_EVENT_STREAM_START, GST_EVENT_SEGMENT}) {
    const EventPtr event(gst_pad_get_sticky_event(map->sinkpad, type, 0));
    EXPECT_TRUE(event) << gst_event_type_get_name(type);
  }
  const BufferPtr pose(gst_harness_pull(map.get()));
  EXPECT_EQ(GST_BUFFER_PTS(pose.get()), 100 * GST_MSECOND);
}

TEST(MapPadWithoutScans, GivesNoPose) {
  const ElementPtr odometry(gst_element_factory_make("lidarodometry", nullptr));
  gst_object_ref_sink(odometry.get());
  g_object_set(odometry.get(), "local-maps", 2, nullptr);
  const Harness h(gst_harness_new_with_element(odometry.get(), "sink", "src"));
  const Harness map(gst_harness_new_with_element(h->element, nullptr, "map"));
  gst_harness_set_src_caps_str(h.get(), kCaps);
  gst_harness_push_event(h.get(), gst_event_new_eos());
  EXPECT_EQ(gst_harness_buffers_received(map.get()), 0U);
}

/// A fixture with a drive of several laps around a block. On the far side of the block the sensor
/// measures up to 2 % too far. Therefore the odometry drifts by metres per lap.
class Laps : public ::testing::Test {
 protected:
  Laps() {
    const ElementPtr element(gst_parse_launch(
        "lidarodometry local-maps=100 deskew=false initial-velocity=\"19.8 0 0 0 0 0.33\"",
        nullptr));
    h_.reset(gst_harness_new_with_element(element.get(), "sink", "src"));
    bus_.emplace(element.get());
    poses_.reset(gst_harness_new_with_element(element.get(), nullptr, "odometry"));
    map_.reset(gst_harness_new_with_element(element.get(), nullptr, "map"));
    gst_harness_set_src_caps_str(h_.get(),
                                 "application/x-pointcloud2,width=0,height=1,point-step=12,"
                                 "fields=(string)\"x:F32:0,y:F32:4,z:F32:8\",framerate=10/1");
  }
  /// Sends EOS, which waits for the loop thread. Then begins a new stream.
  void FindLoops() {
    gst_harness_push_event(h_.get(), gst_event_new_eos());
    map_from_odometry_ = PullFrom(map_.get());
    gst_harness_push_event(h_.get(), gst_event_new_stream_start("laps"));
    gst_harness_push_event(h_.get(), test::NewSegment());
  }
  void DriveOn() {
    const int scan = static_cast<int>(odometry_.size());
    const double angle = block::kTurn * scan / block::kScansOfALap;
    const double scale = 1 + 0.01 * (1 - std::cos(angle));
    std::vector<float> points;
    for (int part = 0; part < 6; ++part)
      for (const Eigen::Vector3d& p : block::SeenFrom(block::TrueAt(scan), world_, part))
        for (const double v : p) points.push_back(static_cast<float>(scale * v));
    GstBuffer* cloud = gst_buffer_new_memdup(points.data(), points.size() * sizeof(float));
    GST_BUFFER_PTS(cloud) = static_cast<GstClockTime>(scan) * 100 * GST_MSECOND;
    ASSERT_EQ(gst_harness_push(h_.get(), cloud), GST_FLOW_OK);
    GstLidarPose meta;
    ASSERT_TRUE(gst_lidar_buffer_get_pose(BufferPtr(gst_harness_pull(h_.get())).get(), &meta));
    metas_.emplace_back(meta.position);
    odometry_.push_back(PullFrom(poses_.get()));
    map_from_odometry_ = PullFrom(map_.get());
  }
  static odometry::Pose PullFrom(GstHarness* pad) {
    const BufferPtr buffer(gst_harness_pull(pad));
    const BufferMap bytes(buffer.get(), GST_MAP_READ);
    std::uint64_t tracking = 0;
    const cdr::Odometry pose = cdr::ReadPose(bytes.view(), &tracking).value();
    EXPECT_LE(tracking, GST_LIDAR_TRACKING_OK);
    return {Eigen::Quaterniond(pose.orientation.data()), Eigen::Vector3d(pose.position.data())};
  }
  /// Returns the number of messages about loops since the last call. Expects that the newest
  /// message has the current pose of the map and the current number of loops.
  unsigned CountLoopMessages() {
    unsigned count = 0;
    guint64 loops = 0;
    Eigen::Vector3d position(0, 0, 0);
    while (const MessagePtr message = bus_->Pop(GST_MESSAGE_ELEMENT)) {
      if (!gst_message_has_name(message.get(), "loop-closed")) continue;
      const GstStructure* s = gst_message_get_structure(message.get());
      gst_structure_get(s, "x", G_TYPE_DOUBLE, &position.x(), "y", G_TYPE_DOUBLE, &position.y(),
                        "z", G_TYPE_DOUBLE, &position.z(), "loops", G_TYPE_UINT64, &loops, nullptr);
      ++count;
    }
    if (count > 0) {
      EXPECT_EQ(loops, test::StatOf(h_->element, "loops"));
      EXPECT_LT((position - map_from_odometry_.position).norm(), 1e-9);
    }
    return count;
  }
  /// Transforms the last pose of the odometry by `frame`. Returns its distance from the true pose.
  double ErrorOf(const odometry::Pose& frame) const {
    const int scan = static_cast<int>(odometry_.size()) - 1;
    return (frame * odometry_.back().position - block::TrueAt(scan).position).norm();
  }

  /// Returns MakeWorld() with its ground points moved at random. A regular grid would match itself
  /// again after it has moved by one step.
  static block::Points WorldWithoutGrid() {
    block::Points world = block::MakeWorld();
    std::mt19937 random(7);
    std::uniform_real_distribution<double> aside(-2.5, 2.5);
    for (Eigen::Vector3d& p : world)
      if (p.z() == -1.9) p += Eigen::Vector3d(aside(random), aside(random), 0);
    return world;
  }

  const block::Points world_ = WorldWithoutGrid();
  Harness h_;
  std::optional<test::ElementBus> bus_;
  Harness poses_;
  Harness map_;
  std::vector<Eigen::Vector3d> metas_;
  std::vector<odometry::Pose> odometry_;
  odometry::Pose map_from_odometry_;
};

TEST_F(Laps, MoveTheMapAndNeverTheOdometry) {
  while (metas_.size() < block::kScansOfALap + 10) {
    DriveOn();
    if (metas_.size() % 50 == 0) FindLoops();  // waits, so that no scan is dropped
  }
  FindLoops();
  EXPECT_GT(map_from_odometry_.position.norm(), 0.5);
  EXPECT_GE(CountLoopMessages(), 1U);
  for (int i = 0; i < 10; ++i) DriveOn();
  EXPECT_EQ(CountLoopMessages(), 0U) << "of loops that were told before";
  EXPECT_GT(ErrorOf({}), 1);
  EXPECT_LT(ErrorOf(map_from_odometry_), 0.3);
  double most = 0;
  for (std::size_t i = 1; i < metas_.size(); ++i) {
    const int scan = static_cast<int>(i);
    const double driven = (block::TrueAt(scan).position - block::TrueAt(scan - 1).position).norm();
    const double moved = (odometry_[i].position - odometry_[i - 1].position).norm();
    const double meta_moved = (metas_[i] - metas_[i - 1]).norm();
    most = std::max({most, moved - driven, meta_moved - driven});
  }
  EXPECT_LT(most, 0.1);
}

}  // namespace
}  // namespace lidar::gst
