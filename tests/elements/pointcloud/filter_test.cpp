// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <unistd.h>

#include <array>
#include <atomic>
#include <fstream>
#include <thread>

#include "gst/common/buffer_map.h"
#include "gst/common/cloud_info.h"
#include "gst/common/latency.h"
#include "src/base/byte_writer.h"
#include "src/cdr/messages.h"
#include "tests/support/harness.h"

namespace lidar::gst {
namespace {

using test::Harness;

/// A thread that does something once, and that others see asleep while it waits for them.
class Waiter {
 public:
  explicit Waiter(std::function<void()> work)
      : thread_([this, work = std::move(work)] {
          id_ = gettid();
          work();
          done_ = true;
        }) {}
  ~Waiter() { thread_.join(); }

  /// Until the kernel says that it sleeps; false where it comes to its end.
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

class Filter : public ::testing::Test {
 protected:
  /// `properties` as gst-launch has them.
  void Start(const std::string& properties, const std::string& caps) {
    const ElementPtr filter(gst_parse_launch(("pointcloudfilter " + properties).c_str(), nullptr));
    h_.reset(gst_harness_new_with_element(filter.get(), "sink", "src"));
    GstBus* bus = gst_bus_new();
    gst_element_set_bus(h_->element, bus);
    gst_object_unref(bus);
    gst_harness_set_src_caps_str(h_.get(), caps.c_str());
  }
  std::string Error() {
    GstBus* bus = gst_element_get_bus(h_->element);
    const MessagePtr message(gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR));
    gst_object_unref(bus);
    if (!message) return "";
    GError* raw = nullptr;
    gst_message_parse_error(message.get(), &raw, nullptr);
    const ErrorPtr error(raw);
    return error->message;
  }
  GstFlowReturn Push(const std::vector<std::uint8_t>& bytes, guint first_column = 0) {
    GstBuffer* buffer = gst_buffer_new_memdup(bytes.data(), bytes.size());
    GST_BUFFER_PTS(buffer) = 0;
    GST_BUFFER_DURATION(buffer) = GST_SECOND;
    const GstLidarSlice slice{1, 0, 2, first_column};
    gst_lidar_buffer_set_slice(buffer, &slice);
    gst_lidar_buffer_set_capture_time(buffer, 77);
    return gst_harness_push(h_.get(), buffer);
  }
  std::optional<CloudInfo> Info() {
    const CapsPtr caps(gst_pad_get_current_caps(h_->sinkpad));
    return CloudInfo::FromCaps(caps.get());
  }

  Harness h_;
};

std::string Caps(const std::string& fields, int step, int width, int height,
                 const std::string& more = "") {
  return "application/x-pointcloud2,width=" + std::to_string(width) +
         ",height=" + std::to_string(height) + ",point-step=" + std::to_string(step) +
         ",fields=(string)\"" + fields + "\"" + more;
}

TEST_F(Filter, ConvertsDoublesAndByteOrderAndChoosesFields) {
  Start("fields=x,y,z,ring:U16",
        Caps("x:F64:0,y:F64:8,z:F64:16,t:F64:24,ring:I32:32", 36, 1, 1, ",is-bigendian=true"));
  std::vector<std::uint8_t> point;
  ByteWriter w(&point);
  for (const double v : {1.5, -2.5, 3.25, 9.0}) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &v, sizeof v);
    w.Be64(bits);
  }
  w.Be32(17);
  ASSERT_EQ(Push(point), GST_FLOW_OK);
  EXPECT_EQ(Info()->fields.ToString(), "x:F32:0,y:F32:4,z:F32:8,ring:U16:12");
  const BufferPtr out(gst_harness_pull(h_.get()));
  const BufferMap map(out.get(), GST_MAP_READ);
  ByteReader r(map.view());
  EXPECT_EQ(map.size(), 14U);
  EXPECT_EQ(r.LeF32(), 1.5F);
  EXPECT_EQ(r.LeF32(), -2.5F);
  EXPECT_EQ(r.LeF32(), 3.25F);
  EXPECT_EQ(r.Le16(), 17U);
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(out.get()), 77U);
}

TEST_F(Filter, WithoutSettingsCloudsAreAsTheyWere) {
  Start("", Caps("x:F32:0,y:F32:4,z:F32:8", 16, 2, 1));
  std::vector<std::uint8_t> bytes(32);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i);
  ASSERT_EQ(Push(bytes), GST_FLOW_OK);
  const BufferPtr out(gst_harness_pull(h_.get()));
  const BufferMap map(out.get(), GST_MAP_READ);
  EXPECT_EQ(std::vector<std::uint8_t>(map.data(), map.data() + map.size()), bytes);
  EXPECT_EQ(Info()->point_step, 16U);
}

TEST_F(Filter, SlicesKeepTheirPlaceAndModelsTheirBeams) {
  CloudInfo info;
  info.width = 4;
  info.height = 2;
  info.point_step = 12;
  info.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8");
  info.sensor_model.emplace();
  info.sensor_model->columns_per_scan = 512;
  info.sensor_model->beams = {{1, 10, 0}, {-1, -10, 4}};
  const CapsPtr caps(info.ToCaps());
  const StringPtr text(gst_caps_to_string(caps.get()));
  Start("beam-step=2", text.get());
  ASSERT_EQ(Push(std::vector<std::uint8_t>(96, 1), 8), GST_FLOW_OK);
  ASSERT_TRUE(Info()->sensor_model);
  EXPECT_EQ(Info()->sensor_model->beams.size(), 1U);
  gst_buffer_unref(gst_harness_pull(h_.get()));
  // A property that changes takes effect with the next cloud.
  g_object_set(h_->element, "column-step", 2, nullptr);
  ASSERT_EQ(Push(std::vector<std::uint8_t>(96, 1), 8), GST_FLOW_OK);
  EXPECT_FALSE(Info()->sensor_model);
  EXPECT_EQ(Info()->width, 2U);
  const BufferPtr out(gst_harness_pull(h_.get()));
  GstLidarSlice slice{};
  gst_lidar_buffer_get_slice(out.get(), &slice);
  EXPECT_EQ(slice.first_column, 4U);
}

TEST_F(Filter, SendsCapsOnceWhileTheyStayTheSame) {
  Start("", Caps("x:F32:0,y:F32:4,z:F32:8", 12, 1, 1));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(Push(std::vector<std::uint8_t>(12, 1)), GST_FLOW_OK);
  int caps = 0;
  while (const EventPtr event{gst_harness_try_pull_event(h_.get())})
    caps += GST_EVENT_TYPE(event.get()) == GST_EVENT_CAPS ? 1 : 0;
  EXPECT_EQ(caps, 1);
}

TEST_F(Filter, ACloudOfWhichNothingIsLeftIsAGap) {
  Start("invalid=remove max-range=1", Caps("x:F32:0,y:F32:4,z:F32:8", 12, 2, 1));
  std::vector<std::uint8_t> near_and_far;
  ByteWriter w(&near_and_far);
  for (const float v : {0.5F, 0.0F, 0.0F, 5.0F, 0.0F, 0.0F}) w.LeF32(v);
  ASSERT_EQ(Push(near_and_far), GST_FLOW_OK);
  EXPECT_EQ(Info()->width, 1U);
  EXPECT_TRUE(Info()->is_dense);
  std::vector<std::uint8_t> far_away;
  ByteWriter v(&far_away);
  for (int i = 0; i < 6; ++i) v.LeF32(7);
  ASSERT_EQ(Push(far_away), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_buffers_received(h_.get()), 1U);
  GstStructure* raw = nullptr;
  g_object_get(h_->element, "stats", &raw, nullptr);
  const StructurePtr stats(raw);
  guint64 removed = 0;
  gst_structure_get_uint64(raw, "points-removed", &removed);
  EXPECT_EQ(removed, 3U);
}

TEST_F(Filter, PutsCloudsWhereTheirPoseSays) {
  Start("apply-pose=true transform=0,0,100,0,0,0", Caps("x:F32:0,y:F32:4,z:F32:8", 12, 2, 1));
  std::vector<std::uint8_t> points;
  ByteWriter w(&points);
  for (const float v : {1.0F, 2.0F, 3.0F, 0.0F, 0.0F, 0.0F}) w.LeF32(v);
  ASSERT_EQ(Push(points), GST_FLOW_OK);  // without a pose
  EXPECT_EQ(gst_harness_buffers_received(h_.get()), 0U);
  GstBuffer* buffer = gst_buffer_new_memdup(points.data(), points.size());
  const GstLidarPose pose{{10, 20, 30}, {0, 0, 1, 0}, GST_LIDAR_TRACKING_OK};
  gst_lidar_buffer_set_pose(buffer, &pose);
  ASSERT_EQ(gst_harness_push(h_.get(), buffer), GST_FLOW_OK);
  const BufferPtr out(gst_harness_pull(h_.get()));
  std::array<float, 6> moved{};
  ASSERT_EQ(gst_buffer_extract(out.get(), 0, moved.data(), sizeof moved), sizeof moved);
  EXPECT_EQ(moved, (std::array<float, 6>{9, 18, 133, 0, 0, 0}));
  GstLidarPose left{};
  EXPECT_FALSE(gst_lidar_buffer_get_pose(out.get(), &left));
  GstStructure* raw = nullptr;
  g_object_get(h_->element, "stats", &raw, nullptr);
  const StructurePtr stats(raw);
  guint64 without = 0;
  gst_structure_get_uint64(raw, "clouds-without-pose", &without);
  EXPECT_EQ(without, 1U);
}

/// pointcloudfilter, and what gives it transforms.
class FilterByTransforms : public Filter {
 protected:
  void Start(const std::string& properties, const std::string& frame = "os") {
    Filter::Start(properties, Caps("x:F32:0,y:F32:4,z:F32:8", 12, 1, 1, ",frame-id=" + frame));
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
  guint64 Stat(const char* name) {
    GstStructure* raw = nullptr;
    g_object_get(h_->element, "stats", &raw, nullptr);
    const StructurePtr stats(raw);
    guint64 value = 0;
    gst_structure_get_uint64(raw, name, &value);
    return value;
  }
  std::string Warning() {
    GstBus* bus = gst_element_get_bus(h_->element);
    const MessagePtr message(gst_bus_pop_filtered(bus, GST_MESSAGE_WARNING));
    gst_object_unref(bus);
    if (!message) return "";
    GError* raw = nullptr;
    gst_message_parse_warning(message.get(), &raw, nullptr);
    const ErrorPtr error(raw);
    return error->message;
  }
  std::string FrameOut() {
    const CapsPtr caps(gst_pad_get_current_caps(h_->sinkpad));
    const gchar* text = gst_structure_get_string(gst_caps_get_structure(caps.get(), 0), "frame-id");
    return text != nullptr ? text : "";
  }

  Harness fixed_;
  Harness moving_;
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
  // Clouds that do not say when they were taken: the newest counts.
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
            "A cloud of os cannot be put into map: no transform names the frame map. Such clouds "
            "are dropped and counted.");
  EXPECT_EQ(Warning(), "");
  Tell(fixed_.get(), "map", "os", 0, 10);
  EXPECT_EQ(PushAt(100), GST_FLOW_OK);
  EXPECT_EQ(PulledX(), 11);
  EXPECT_EQ(Stat("clouds-without-transform"), 3U);
}

TEST_F(FilterByTransforms, NobodyWaitsForTransformsThatHaveEnded) {
  Start("target-frame=map tf-timeout=60000000000");
  for (const Harness* h : {&fixed_, &moving_})
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
  GstBus* bus = gst_element_get_bus(h_->element);
  const auto told = [bus] { return MessagePtr(gst_bus_pop_filtered(bus, GST_MESSAGE_LATENCY)); };
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
  gst_object_unref(bus);
  gst_harness_set_live(h_.get(), FALSE);
  const QueryPtr query(gst_query_new_latency());
  ASSERT_TRUE(gst_pad_peer_query(h_->sinkpad, query.get()));
  EXPECT_EQ(ReadLatency(query.get()).min, 0U);
}

TEST_F(FilterByTransforms, TakesThePosesOfAnOdometry) {
  Start("target-frame=odom tf-timeout=0", "base");
  Harness poses(gst_harness_new_with_element(h_->element, "tf_%u", nullptr));
  gst_harness_set_src_caps_str(poses.get(), "application/x-odometry,child-frame-id=base");
  std::vector<std::uint8_t> bytes;
  ByteWriter w(&bytes);
  for (const double v : {5., 0., 0., 0., 0., 0., 1.}) w.LeF64(v);
  w.Le64(GST_LIDAR_TRACKING_OK);
  GstBuffer* pose = gst_buffer_new_memdup(bytes.data(), bytes.size());
  gst_lidar_buffer_set_capture_time(pose, 100 * GST_SECOND);
  EXPECT_EQ(gst_harness_push(poses.get(), pose), GST_FLOW_OK);
  EXPECT_EQ(PushAt(100), GST_FLOW_OK);
  EXPECT_EQ(PulledX(), 6);
}

TEST_F(FilterByTransforms, WhatIsNoTransformIsCounted) {
  Start("target-frame=map tf-timeout=0");
  EXPECT_EQ(gst_harness_push(fixed_.get(), gst_buffer_new_memdup("garbage", 7)), GST_FLOW_OK);
  Tell(fixed_.get(), "map", "map", 0, 1);
  EXPECT_EQ(Stat("transforms-refused"), 2U);
  EXPECT_EQ(Stat("transforms"), 0U);
}

TEST_F(FilterByTransforms, TheFrameStaysWherePointsDo) {
  Start("");
  ASSERT_EQ(PushAt(1), GST_FLOW_OK);
  EXPECT_EQ(FrameOut(), "os");
  g_object_set(h_->element, "transform", "1,0,0,0,0,0", nullptr);
  ASSERT_EQ(PushAt(1), GST_FLOW_OK);
  EXPECT_EQ(FrameOut(), "");
}

TEST_F(Filter, NoGapComesBeforeTheCaps) {
  Start("", Caps("x:F32:0,y:F32:4,z:F32:8", 12, 2, 1));
  ASSERT_TRUE(gst_harness_push_event(h_.get(), gst_event_new_gap(0, GST_SECOND)));
  ASSERT_EQ(Push(std::vector<std::uint8_t>(24)), GST_FLOW_OK);
  ASSERT_TRUE(gst_harness_push_event(h_.get(), gst_event_new_gap(0, GST_SECOND)));
  std::vector<std::string> names;
  while (const lidar::gst::EventPtr event{gst_harness_try_pull_event(h_.get())})
    names.emplace_back(GST_EVENT_TYPE_NAME(event.get()));
  EXPECT_EQ(names, (std::vector<std::string>{"stream-start", "caps", "segment", "gap"}));
}

TEST_F(Filter, SaysWhatIsWrong) {
  const std::string caps = Caps("x:F32:0,y:F32:4,z:F32:8", 12, 1, 1);
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"transform=1,2,3", "transform wants 16 numbers, or x, y, z, roll, pitch, yaw"},
      {"crop-box=1,2,3", "crop-box wants six numbers: the least x, y, z, then the largest"},
      {"crop-box=5,0,0,1,1,1", "crop-box wants six numbers: the least x, y, z, then the largest"},
      {"apply-pose=true target-frame=map", "apply-pose and target-frame exclude each other"},
      {"fields=x,q", "there is no field q among x:F32:0,y:F32:4,z:F32:8"},
      {"fields=x,x", "there are two fields x"},
      {"fields=x max-range=3",
       "these settings need x, y and z as F32 side by side, and the fields are x:F32:0"},
  };
  for (const auto& [properties, why] : wrong) {
    Start(properties, caps);
    EXPECT_EQ(Error(), "Clouds cannot be filtered so: " + why + ".");
    EXPECT_NE(Push(std::vector<std::uint8_t>(12)), GST_FLOW_OK);
  }
  Start("", caps);
  EXPECT_EQ(Push(std::vector<std::uint8_t>(13)), GST_FLOW_ERROR);
}

}  // namespace
}  // namespace lidar::gst
