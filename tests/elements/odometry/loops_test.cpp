// SPDX-License-Identifier: LGPL-2.1-or-later
// Loop closure: its thread, and what lidarodometry makes of its results.
#include <gtest/gtest.h>

#include "ext/odometry/loop_thread.h"
#include "gst/common/buffer_map.h"
#include "gst/lidar/gstlidar.h"
#include "src/cdr/motion_samples.h"
#include "tests/support/block_drive.h"
#include "tests/support/harness.h"

namespace lidar::gst {
namespace {

namespace block = test::block;

TEST(LoopThread, HasTheDriftOfALapWhenItFinishes) {
  const block::Points world = block::MakeWorld();
  const odometry::Trajectory drifted = block::Drive(block::kScansOfALap + 30);
  LoopThread loops({});
  for (std::size_t i = 0; i < drifted.size(); ++i) {
    const int scan = static_cast<int>(i);
    loops.AddScan(drifted[i], block::SeenFrom(block::TrueAt(scan), world, scan));
    if (i % 50 == 0) loops.Finish();  // so that no scan is dropped
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

/// A drive through lidarodometry with a sink for the poses of its map.
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
    GstStructure* stats = nullptr;
    g_object_get(odometry.get(), "stats", &stats, nullptr);
    gst_structure_get_uint64(stats, "local-maps", &local_maps_);
    gst_structure_free(stats);
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
  EXPECT_EQ(poses_, 27U);  // one for each scan, and those that the last loops changed
  const GstStructure* s = gst_caps_get_structure(caps_.get(), 0);
  EXPECT_STREQ(gst_structure_get_string(s, "frame-id"), "map");
  EXPECT_STREQ(gst_structure_get_string(s, "child-frame-id"), "odom");
  EXPECT_EQ(local_maps_, 2U);
  EXPECT_NEAR(last_.orientation[3], 1, 1e-9);  // the drive does not return
  EXPECT_NEAR(last_.position[0], 0, 1e-9);
}

TEST_F(MapPad, IsTheOdometryWhereLoopsAreNotClosed) {
  Play(5, "");
  EXPECT_EQ(poses_, 5U);
  EXPECT_EQ(local_maps_, 0U);
  EXPECT_EQ(last_.orientation[3], 1);
}

}  // namespace
}  // namespace lidar::gst
