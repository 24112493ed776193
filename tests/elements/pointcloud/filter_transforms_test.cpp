// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of a pointcloudfilter that moves clouds into another frame.
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <functional>
#include <thread>

#include "gst/common/latency.h"
#include "src/base/byte_writer.h"
#include "src/cdr/messages.h"
#include "tests/elements/pointcloud/filter_fixture.h"
#include "tests/support/element_stats.h"

namespace lidar::gst {
namespace {

/// A thread that runs a function once. Tests can wait until the thread sleeps.
class Waiter {
 public:
  explicit Waiter(std::function<void()> work)
      : thread_([this, work = std::move(work)] {
          id_ = gettid();
          work();
          done_ = true;
        }) {}
  ~Waiter() { thread_.join(); }

  /// Waits until the kernel reports that the thread sleeps. Returns false if the thread ends
  /// before.
  bool AwaitSleep() const {
    while (!done_) {
      std::ifstream stat("/proc/self/task/" + std::to_string(id_) + "/stat");
      std::string text;
      std::getline(stat, text);
      const auto name_end = text.rfind(')');
      if (name_end != std::string::npos && text.compare(name_end, 4, ") S ") == 0) return true;
      g_usleep(1000);
    }
    return false;
  }

 private:
  std::atomic<pid_t> id_{-1};
  std::atomic<bool> done_{false};
  std::thread thread_;
};

/// A fixture with a pointcloudfilter, a source of static transforms, and a source of moving
/// transforms.
class FilterByTransforms : public Filter {
 protected:
  void Start(const std::string& properties, const std::string& frame = "os") {
    Filter::Start(properties, CloudCaps("x:F32:0,y:F32:4,z:F32:8", 12, 1, 1, ",frame-id=" + frame));
    fixed_.reset(gst_harness_new_with_element(h_->element, "tf_%u", nullptr));
    gst_harness_set_src_caps_str(fixed_.get(), "application/x-tf,static=true");
    moving_.reset(gst_harness_new_with_element(h_->element, "tf_%u", nullptr));
    gst_harness_set_src_caps_str(moving_.get(), "application/x-tf,static=false");
  }
  void Tell(GstHarness* h, const char* parent, const char* child, int second, double x) {
    cdr::TransformStamped t;
    t.header = {Time{} + std::chrono::seconds(second), parent};
    t.child_frame_id = child;
    t.translation = {x, 0, 0};
    const auto bytes = cdr::WriteTransforms({t});
    EXPECT_EQ(gst_harness_push(h, gst_buffer_new_memdup(bytes.data(), bytes.size())), GST_FLOW_OK);
  }
  GstFlowReturn PushAt(int second) {
    std::vector<std::uint8_t> point;
    ByteWriter w(&point);
    for (const float v : {1.0F, 2.0F, 3.0F}) w.LeF32(v);
    GstBuffer* buffer = gst_buffer_new_memdup(point.data(), point.size());
    gst_lidar_buffer_set_capture_time(buffer, static_cast<GstClockTime>(second) * GST_SECOND);
    return gst_harness_push(h_.get(), buffer);
  }
  float PulledX() {
    const BufferPtr out(gst_harness_pull(h_.get()));
    float x = 0;
    gst_buffer_extract(out.get(), 0, &x, sizeof x);
    return x;
  }
  guint64 Stat(const char* name) { return test::StatOf(h_->element, name); }
  std::string Warning() { return bus_->Text(GST_MESSAGE_WARNING); }
  std::string FrameOut() {
    const CapsPtr caps(gst_pad_get_current_caps(h_->sinkpad));
    const gchar* text = gst_structure_get_string(gst_caps_get_structure(caps.get(), 0), "frame-id");
    return text != nullptr ? text : "";
  }

  test::Harness fixed_;
  test::Harness moving_;
};

TEST_F(FilterByTransforms, CloudsGoToTheTargetFrameAsItIsAtTheirTime) {
  Start("target-frame=map tf-timeout=0");
  Tell(fixed_.get(), "base", "os", 0, 10);
  Tell(moving_.get(), "map", "base", 100, 1000);
  Tell(moving_.get(), "map", "base", 102, 3000);
  ASSERT_EQ(PushAt(101), GST_FLOW_OK);
  EXPECT_EQ(PulledX(), 2011);
  EXPECT_EQ(FrameOut(), "map");
  EXPECT_EQ(Stat("transforms"), 3U);
  // For clouds without a capture time, the newest transform applies.
  ASSERT_EQ(Push(std::vector<std::uint8_t>(12, 0)), GST_FLOW_OK);
}

TEST_F(FilterByTransforms, ACloudWaitsForItsTransform) {
  Start("target-frame=map tf-timeout=60000000000");
  Tell(moving_.get(), "map", "os", 100, 1);
  {
    const Waiter cloud([this] { EXPECT_EQ(PushAt(101), GST_FLOW_OK); });
    EXPECT_TRUE(cloud.AwaitSleep());
    Tell(moving_.get(), "map", "os", 102, 3);
  }
  EXPECT_EQ(PulledX(), 3);
  EXPECT_EQ(Warning(), "");
}

TEST_F(FilterByTransforms, CloudsWithoutAreCountedAndReportedOnce) {
  Start("target-frame=map tf-timeout=1000000");
  for (int i = 0; i < 3; ++i) EXPECT_EQ(PushAt(100), GST_FLOW_OK);
  EXPECT_EQ(Warning(),
            "A cloud of the frame os cannot be transformed into the frame map: no transform names "
            "the frame "
            "map. Such clouds are dropped and counted.");
  EXPECT_EQ(Warning(), "");
  Tell(fixed_.get(), "map", "os", 0, 10);
  EXPECT_EQ(PushAt(100), GST_FLOW_OK);
  EXPECT_EQ(PulledX(), 11);
  EXPECT_EQ(Stat("clouds-without-transform"), 3U);
}

TEST_F(FilterByTransforms, EachLossOfTheTransformIsReported) {
  Start("target-frame=map tf-timeout=0");
  Tell(moving_.get(), "map", "os", 100, 1);
  for (const int second : {200, 200, 100, 200, 200}) EXPECT_EQ(PushAt(second), GST_FLOW_OK);
  EXPECT_EQ(bus_->Texts(GST_MESSAGE_WARNING).size(), 2U);
}

TEST_F(FilterByTransforms, NobodyWaitsForTransformsThatHaveEnded) {
  Start("target-frame=map tf-timeout=60000000000");
  for (const test::Harness* h : {&fixed_, &moving_})
    EXPECT_TRUE(gst_harness_push_event(h->get(), gst_event_new_eos()));
  EXPECT_EQ(PushAt(100), GST_FLOW_OK);
  EXPECT_EQ(Stat("clouds-without-transform"), 1U);
  EXPECT_EQ(gst_harness_buffers_received(h_.get()), 0U);
}

TEST_F(FilterByTransforms, AFlushEndsTheWait) {
  Start("target-frame=map tf-timeout=60000000000");
  const gint64 begin = g_get_monotonic_time();
  {
    const Waiter cloud([this] { EXPECT_EQ(PushAt(100), GST_FLOW_FLUSHING); });
    EXPECT_TRUE(cloud.AwaitSleep());
    gst_harness_push_event(h_.get(), gst_event_new_flush_start());
  }
  EXPECT_EQ(Stat("clouds-without-transform"), 0U);
  EXPECT_LT(g_get_monotonic_time() - begin, 50 * G_USEC_PER_SEC);
}

TEST_F(FilterByTransforms, ALivePipelineKnowsHowLongCloudsWait) {
  Start("target-frame=map tf-timeout=150000000");
  gst_harness_set_upstream_latency(h_.get(), 20 * GST_MSECOND);
  EXPECT_EQ(gst_harness_query_latency(h_.get()), 170 * GST_MSECOND);
  const test::ElementBus bus(h_->element);
  const auto told = [&bus] { return bus.Pop(GST_MESSAGE_LATENCY); };
  while (told()) continue;
  g_object_set(h_->element, "tf-timeout", guint64{50 * GST_MSECOND}, nullptr);
  EXPECT_TRUE(told());
  EXPECT_EQ(gst_harness_query_latency(h_.get()), 70 * GST_MSECOND);
  g_object_set(h_->element, "target-frame", "", nullptr);
  EXPECT_TRUE(told());
  EXPECT_EQ(gst_harness_query_latency(h_.get()), 20 * GST_MSECOND);
  g_object_set(h_->element, "max-range", 5.0, nullptr);
  EXPECT_FALSE(told());
  g_object_set(h_->element, "target-frame", "map", nullptr);
  gst_harness_set_live(h_.get(), FALSE);
  const QueryPtr query(gst_query_new_latency());
  ASSERT_TRUE(gst_pad_peer_query(h_->sinkpad, query.get()));
  EXPECT_EQ(ReadLatency(query.get()).min, 0U);
}

TEST_F(FilterByTransforms, TakesThePosesOfAnOdometry) {
  Start("target-frame=odom tf-timeout=0", "base");
  const test::Harness poses(gst_harness_new_with_element(h_->element, "tf_%u", nullptr));
  gst_harness_set_src_caps_str(poses.get(), "application/x-odometry,child-frame-id=base");
  std::vector<std::uint8_t> bytes;
  ByteWriter w(&bytes);
  for (const double v : {5., 0., 0., 0., 0., 0., 1.}) w.LeF64(v);
  w.Le64(GST_LIDAR_TRACKING_OK);
  const auto push = [&](GstClockTime second) {
    GstBuffer* pose = gst_buffer_new_memdup(bytes.data(), bytes.size());
    gst_lidar_buffer_set_capture_time(pose, second * GST_SECOND);
    EXPECT_EQ(gst_harness_push(poses.get(), pose), GST_FLOW_OK);
  };
  push(100);
  EXPECT_EQ(PushAt(100), GST_FLOW_OK);
  EXPECT_EQ(PulledX(), 6);
  bytes[6] = 0x1C;  // changes the number 5.0 to 7.0
  push(102);
  EXPECT_EQ(PushAt(101), GST_FLOW_OK);
  EXPECT_EQ(PulledX(), 7) << "a pose is of its time";
}

TEST_F(FilterByTransforms, WhatIsNoTransformIsCounted) {
  Start("target-frame=map tf-timeout=0");
  EXPECT_EQ(gst_harness_push(fixed_.get(), gst_buffer_new_memdup("garbage", 7)), GST_FLOW_OK);
  Tell(fixed_.get(), "map", "map", 0, 1);
  EXPECT_EQ(Stat("transforms-refused"), 2U);
  EXPECT_EQ(Stat("transforms"), 0U);
}

/// If the cloud kept its pose, another filter would move the points a second time.
TEST_F(FilterByTransforms, ACloudInItsTargetFrameHasNoPoseLeft) {
  Start("target-frame=map tf-timeout=0");
  Tell(fixed_.get(), "map", "os", 0, 10);
  GstBuffer* cloud = gst_buffer_new_allocate(nullptr, 12, nullptr);
  gst_buffer_memset(cloud, 0, 1, 12);
  GstLidarPose pose{{1, 2, 3}, {0, 0, 0, 1}, GST_LIDAR_TRACKING_OK, {}};
  gst_lidar_buffer_set_pose(cloud, &pose);
  const BufferPtr out(gst_harness_push_and_pull(h_.get(), cloud));
  EXPECT_FALSE(gst_lidar_buffer_get_pose(out.get(), &pose));
}

TEST_F(FilterByTransforms, TheFrameStaysWherePointsDo) {
  Start("");
  ASSERT_EQ(PushAt(1), GST_FLOW_OK);
  EXPECT_EQ(FrameOut(), "os");
  g_object_set(h_->element, "transform", "1,0,0,0,0,0", nullptr);
  ASSERT_EQ(PushAt(1), GST_FLOW_OK);
  EXPECT_EQ(FrameOut(), "");
  Tell(fixed_.get(), "map", "os", 0, 10);
  g_object_set(h_->element, "target-frame", "map", nullptr);
  ASSERT_EQ(PushAt(1), GST_FLOW_OK);
  EXPECT_EQ(FrameOut(), "") << "the transform moves points on from there";
  g_object_set(h_->element, "transform", "", nullptr);
  ASSERT_EQ(PushAt(1), GST_FLOW_OK);
  EXPECT_EQ(FrameOut(), "map");
}

TEST_F(FilterByTransforms, CloudsWaitAgainBehindAFlush) {
  Start("target-frame=map tf-timeout=60000000000");
  test::Flush(h_.get());
  {
    const Waiter cloud([this] { EXPECT_EQ(PushAt(100), GST_FLOW_OK); });
    EXPECT_TRUE(cloud.AwaitSleep());
    Tell(fixed_.get(), "map", "os", 0, 10);
  }
  EXPECT_EQ(PulledX(), 11);
}

TEST_F(FilterByTransforms, CloudsWaitForAStreamOfTransformsThatBeginsAgain) {
  Start("target-frame=map tf-timeout=60000000000");
  for (const bool flushed : {false, true}) {
    const int second = flushed ? 110 : 100;
    Tell(moving_.get(), "map", "os", second, 1);
    for (const test::Harness* h : {&fixed_, &moving_})
      gst_harness_push_event(h->get(), gst_event_new_eos());
    if (flushed) {
      gst_harness_push_event(moving_.get(), gst_event_new_flush_start());
      gst_harness_push_event(moving_.get(), gst_event_new_flush_stop(TRUE));
    } else {
      gst_harness_push_event(moving_.get(), gst_event_new_stream_start("again"));
    }
    gst_harness_push_event(moving_.get(), test::NewSegment());
    {
      const Waiter cloud([&] { EXPECT_EQ(PushAt(second + 1), GST_FLOW_OK); });
      EXPECT_TRUE(cloud.AwaitSleep()) << flushed;
      Tell(moving_.get(), "map", "os", second + 2, 3);
    }
    ASSERT_EQ(gst_harness_buffers_in_queue(h_.get()), 1U) << flushed;
    EXPECT_EQ(PulledX(), 3);
  }
}

/// If a cloud has waited for a transform in vain, later clouds of the same run do not wait for this
/// transform. In a new run, clouds wait again.
TEST_F(FilterByTransforms, ASecondRunWaitsAgain) {
  Start("target-frame=map tf-timeout=1000000");
  Tell(moving_.get(), "map", "os", 100, 1);
  EXPECT_EQ(PushAt(101), GST_FLOW_OK);
  EXPECT_EQ(Stat("clouds-without-transform"), 1U);
  gst_element_set_state(h_->element, GST_STATE_NULL);
  gst_util_set_object_arg(G_OBJECT(h_->element), "tf-timeout", "60000000000");
  for (const test::Harness* h : {&h_, &fixed_, &moving_}) gst_harness_play(h->get());
  EXPECT_EQ(Stat("transforms"), 0U);
  gst_harness_set_src_caps_str(
      h_.get(), CloudCaps("x:F32:0,y:F32:4,z:F32:8", 12, 1, 1, ",frame-id=os").c_str());
  gst_harness_set_src_caps_str(moving_.get(), "application/x-tf,static=false");
  Tell(moving_.get(), "map", "os", 100, 1);
  {
    const Waiter cloud([this] { EXPECT_EQ(PushAt(101), GST_FLOW_OK); });
    EXPECT_TRUE(cloud.AwaitSleep());
    Tell(moving_.get(), "map", "os", 102, 3);
  }
  EXPECT_EQ(Stat("clouds-without-transform"), 0U);
}

TEST_F(FilterByTransforms, NobodyWaitsForTransformsOfAPadThatIsGone) {
  Start("target-frame=map tf-timeout=60000000000");
  for (const test::Harness* h : {&fixed_, &moving_})
    EXPECT_TRUE(gst_harness_push_event(h->get(), gst_event_new_eos()));
  const PadPtr pad(gst_element_request_pad_simple(h_->element, "tf_%u"));
  gst_element_release_request_pad(h_->element, pad.get());
  const gint64 begin = g_get_monotonic_time();
  EXPECT_EQ(PushAt(100), GST_FLOW_OK);
  EXPECT_EQ(Stat("clouds-without-transform"), 1U);
  EXPECT_LT(g_get_monotonic_time() - begin, 50 * G_USEC_PER_SEC);
}

TEST_F(FilterByTransforms, APoseWithoutATimeIsRefused) {
  Start("target-frame=odom tf-timeout=0", "base");
  const test::Harness poses(gst_harness_new_with_element(h_->element, "tf_%u", nullptr));
  gst_harness_set_src_caps_str(poses.get(), "application/x-odometry,child-frame-id=base");
  std::vector<std::uint8_t> bytes;
  ByteWriter w(&bytes);
  for (const double v : {5., 0., 0., 0., 0., 0., 1.}) w.LeF64(v);
  w.Le64(GST_LIDAR_TRACKING_OK);
  EXPECT_EQ(gst_harness_push(poses.get(), gst_buffer_new_memdup(bytes.data(), bytes.size())),
            GST_FLOW_OK);
  EXPECT_EQ(Stat("transforms-refused"), 1U);
  GstBuffer* garbage = gst_buffer_new_memdup("garbage", 7);
  gst_lidar_buffer_set_capture_time(garbage, 100 * GST_SECOND);
  EXPECT_EQ(gst_harness_push(poses.get(), garbage), GST_FLOW_OK);
  EXPECT_EQ(Stat("transforms-refused"), 2U);
  EXPECT_EQ(Stat("transforms"), 0U);
}

TEST_F(FilterByTransforms, ACloudDoesNotWaitForWhatTheOneBeforeWaitedForInVain) {
  Start("target-frame=map tf-timeout=1000000");
  Tell(moving_.get(), "map", "os", 100, 1);
  EXPECT_EQ(PushAt(101), GST_FLOW_OK);
  gst_util_set_object_arg(G_OBJECT(h_->element), "tf-timeout", "60000000000");
  const gint64 begin = g_get_monotonic_time();
  EXPECT_EQ(PushAt(102), GST_FLOW_OK);
  EXPECT_EQ(Stat("clouds-without-transform"), 2U);
  EXPECT_LT(g_get_monotonic_time() - begin, 50 * G_USEC_PER_SEC);
}

TEST_F(FilterByTransforms, APadWithoutANameIsNumberedBehindAllOthers) {
  Start("");
  for (const auto& [asked, given] :
       std::vector<std::pair<const char*, std::string>>{{"tf_5", "tf_5"},
                                                        {"tf_3", "tf_3"},
                                                        {"tf_%u", "tf_6"},
                                                        {"tf_4294967294", "tf_4294967294"},
                                                        {"tf_%u", "tf_4294967295"},
                                                        {"tf_%u", "tf_4294967296"}}) {
    const PadPtr pad(gst_element_request_pad_simple(h_->element, asked));
    ASSERT_TRUE(pad);
    EXPECT_EQ(GST_PAD_NAME(pad.get()), given);
  }
}

}  // namespace
}  // namespace lidar::gst
