// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of pointcloudmerge, which merges the scans of several sensors into one cloud.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "gst/lidar/gstlidar.h"
#include "tests/elements/mcap/recording.h"
#include "tests/support/clock_wait.h"
#include "tests/support/harness.h"

namespace lidar::test {
namespace {

class Merge : public Recording {};

/// Returns the number of points of a cloud that have a return. Each point has 20 bytes.
std::size_t Returns(const Kept& cloud) {
  std::size_t count = 0;
  for (std::size_t at = 0; at < cloud.bytes.size(); at += 20) {
    float xyz[3];
    std::memcpy(xyz, cloud.bytes.data() + at, sizeof xyz);
    count += xyz[0] != 0 || xyz[1] != 0 || xyz[2] != 0 ? 1 : 0;
  }
  return count;
}

float X(const Kept& cloud, std::size_t point) {
  float x = 0;
  std::memcpy(&x, cloud.bytes.data() + point * 20, sizeof x);
  return x;
}

TEST_F(Merge, TwoSensorsBecomeOneCloudInOneFrame) {
  const std::string scans = " num-buffers=24 ! scanassembler ! ";
  const auto outcome = Play(
      "pointcloudmerge name=m sink_1::transform=10,0,0,0,0,180 ! fakesink "
      "name=see " +
      kSensor + scans + "identity name=see0 ! queue ! m.sink_0 " + kSensor + scans +
      "queue ! m.sink_1");
  EXPECT_EQ(outcome.error, "");
  const auto& merged = outcome.buffers.at("see");
  const auto& one = outcome.buffers.at("see0");
  ASSERT_EQ(merged.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t returns = Returns(one[i]);
    ASSERT_EQ(merged[i].bytes.size(), 2 * 20 * returns);  // both sensors see the same world
    EXPECT_EQ(merged[i].pts, one[i].pts);
    EXPECT_EQ(merged[i].capture_time, one[i].capture_time);
    for (std::size_t k = 0; k < returns; k += 97)
      EXPECT_NEAR(X(merged[i], returns + k), 10 - X(merged[i], k), 1e-4);
  }
  EXPECT_NE(outcome.caps.at("see").find("height=(int)1"), std::string::npos);
}

TEST_F(Merge, OtherFieldsBecomeThoseOfTheFirst) {
  const auto outcome =
      Play("pointcloudmerge name=m ! fakesink name=see " + kSensor +
           " num-buffers=8 ! scanassembler ! pointcloudfilter fields=x,y,z,range:F32 ! queue ! "
           "m.sink_0 " +
           kSensor + " num-buffers=8 ! scanassembler ! queue ! m.sink_1");
  EXPECT_EQ(outcome.error, "");
  EXPECT_NE(outcome.caps.at("see").find("range:F32:12"), std::string::npos);
}

TEST_F(Merge, ASensorThatStartsLaterIsJoinedAtItsTurn) {
  Pipeline p("pointcloudmerge name=m ! fakesink name=see " + kSensor +
             " num-buffers=80 ! scanassembler ! queue ! m.sink_0 " + kSensor +
             " num-buffers=40 ! scanassembler name=late ! queue ! m.sink_1");
  const gst::ElementPtr late = p.Find("late");
  const gst::PadPtr pad(gst_element_get_static_pad(late.get(), "src"));
  gst_pad_set_offset(pad.get(), 300 * GST_MSECOND);
  const auto outcome = p.Run();
  EXPECT_EQ(outcome.error, "");
  // The first three and the last two scans of the first sensor have no partner.
  const auto& merged = outcome.buffers.at("see");
  ASSERT_GE(merged.size(), 5U);
  EXPECT_EQ(merged.front().pts, 300 * GST_MSECOND);
}

TEST_F(Merge, StandsBeforeElementsThatNeedTheFields) {
  const auto outcome = Play("pointcloudmerge name=m ! pointcloudfilter ! fakesink name=see " +
                            kSensor + " num-buffers=8 ! scanassembler ! queue ! m.sink_0 " +
                            kSensor + " num-buffers=8 ! scanassembler ! queue ! m.sink_1");
  EXPECT_EQ(outcome.error, "");
  EXPECT_EQ(outcome.buffers.at("see").size(), 1U);
}

TEST_F(Merge, ASensorThatSeesNothingIsNoError) {
  const auto outcome = Play("pointcloudmerge name=m ! fakesink name=see " + kSensor +
                            " num-buffers=24 ! scanassembler ! pointcloudfilter invalid=remove "
                            "crop-box=9000,9000,9000,9001,9001,9001 ! queue ! m.sink_0 " +
                            kSensor + " num-buffers=24 ! scanassembler ! queue ! m.sink_1");
  EXPECT_EQ(outcome.error, "");
}

TEST_F(Merge, SaysWhatIsWrong) {
  const std::string scan = kSensor + " num-buffers=1 slices-per-scan=1 ! ";
  EXPECT_EQ(Play("pointcloudmerge name=m sink_0::transform=1,2 ! fakesink " + scan + "m.").error,
            "The clouds of the pad sink_0 cannot be merged: transform must be 16 numbers, or x, y, "
            "z, roll, "
            "pitch, yaw.");
  EXPECT_EQ(
      Play("pointcloudmerge name=m ! fakesink " + scan + "m.sink_0 " + scan +
           "pointcloudfilter fields=x,y,z ! m.sink_1")
          .error,
      "The clouds of the pad sink_1 cannot be merged: there is no field intensity; the cloud has "
      "x:F32:0,y:F32:4,z:F32:8.");
  EXPECT_NE(Play("pointcloudmerge name=m ! fakesink " + kSensor + " num-buffers=8 ! m.").warning,
            "");
}

TEST_F(Merge, CloudsWithoutTimesAreAnError) {
  EXPECT_EQ(Play("fakesrc num-buffers=2 sizetype=fixed sizemax=160 format=bytes ! "
                 "application/x-pointcloud2,width=10,height=1,point-step=16,"
                 "fields=(string)\"x:F32:0,y:F32:4,z:F32:8\" ! pointcloudmerge ! fakesink")
                .error,
            "The clouds of the pad sink_0 cannot be merged: they have no timestamps; "
            "pointcloudparse adds them.");
}

/// A fixture with a pointcloudmerge with two pads. Its clouds have one point.
class MergedByHand : public ::testing::Test {
 protected:
  static constexpr const char* kCaps =
      "application/x-pointcloud2,width=1,height=1,point-step=12,"
      "fields=(string)\"x:F32:0,y:F32:4,z:F32:8\",is-bigendian=false,is-dense=true";

  MergedByHand() {
    gst_object_ref_sink(element_.get());
    first_.reset(gst_harness_new_with_element(element_.get(), "sink_0", "src"));
    second_.reset(gst_harness_new_with_element(element_.get(), "sink_1", nullptr));
    for (GstHarness* h : {first_.get(), second_.get()}) gst_harness_set_src_caps_str(h, kCaps);
  }
  static constexpr GstClockTime kUnset = G_MAXUINT64;

  static void Push(const Harness& h, float x, GstClockTime time_ms,
                   GstClockTime duration_ms = 100) {
    const float xyz[3] = {x, 1, 0};
    GstBuffer* buffer = gst_buffer_new_memdup(xyz, sizeof xyz);
    GST_BUFFER_PTS(buffer) = time_ms * GST_MSECOND;
    if (duration_ms != kUnset) GST_BUFFER_DURATION(buffer) = duration_ms * GST_MSECOND;
    gst_lidar_buffer_set_capture_time(buffer, (1'000'000 + time_ms) * GST_MSECOND);
    ASSERT_EQ(gst_harness_push(h.get(), buffer), GST_FLOW_OK);
  }
  void ExpectCloud(const std::vector<float>& xs, GstClockTime time_ms,
                   GstClockTime duration_ms = 100) {
    const gst::BufferPtr cloud(gst_harness_pull(first_.get()));
    ASSERT_TRUE(cloud);
    EXPECT_EQ(GST_BUFFER_PTS(cloud.get()), time_ms * GST_MSECOND);
    EXPECT_EQ(GST_BUFFER_DURATION(cloud.get()), duration_ms * GST_MSECOND);
    EXPECT_EQ(gst_lidar_buffer_get_capture_time(cloud.get()), (1'000'000 + time_ms) * GST_MSECOND);
    std::vector<float> points(3 * xs.size());
    ASSERT_EQ(gst_buffer_get_size(cloud.get()), 4 * points.size());
    gst_buffer_extract(cloud.get(), 0, points.data(), 4 * points.size());
    for (std::size_t i = 0; i < xs.size(); ++i) EXPECT_FLOAT_EQ(points[3 * i], xs[i]);
  }

  /// Expects that the newest gap event begins at this time.
  void ExpectGap(GstClockTime time_ms) {
    GstClockTime time = 0;
    GstClockTime duration = 0;
    while (const gst::EventPtr event{gst_harness_try_pull_event(first_.get())})
      if (GST_EVENT_TYPE(event.get()) == GST_EVENT_GAP)
        gst_event_parse_gap(event.get(), &time, &duration);
    EXPECT_EQ(time, time_ms * GST_MSECOND);
    EXPECT_EQ(duration, 100 * GST_MSECOND);
  }

  const gst::ElementPtr element_{gst_element_factory_make("pointcloudmerge", nullptr)};
  Harness first_;
  Harness second_;
};

TEST_F(MergedByHand, ScansThatOverlapAreOneCloudOfTheEarliersTime) {
  Push(first_, 1, 100);
  Push(second_, 2, 199);
  ExpectCloud({1, 2}, 100);
  Push(first_, 3, 250, 80);
  Push(second_, 4, 210, 70);
  ExpectCloud({3, 4}, 210, 70);
}

TEST_F(MergedByHand, AScanThatEndsAsTheOtherBeginsIsOfAnEarlierTurn) {
  Push(first_, 1, 100);
  Push(second_, 2, 200);
  Push(first_, 3, 200);
  ExpectCloud({3, 2}, 200);
}

TEST_F(MergedByHand, AScanWithoutADurationTakesATenthOfASecond) {
  Push(first_, 1, 100, kUnset);
  Push(second_, 2, 199);
  ExpectCloud({1, 2}, 100);
  Push(first_, 3, 300, kUnset);
  Push(second_, 4, 400);
  Push(first_, 5, 410);
  ExpectCloud({5, 4}, 400);
}

TEST_F(MergedByHand, SoDoesAScanWhoseDurationIsZero) {
  Push(first_, 1, 100, 0);
  Push(second_, 2, 150, 0);
  ExpectCloud({1, 2}, 100);
}

/// The element waits for a live sensor until the end of that sensor's last cloud plus the latency.
/// It must also do this after a turn in which no sensor saw anything.
TEST_F(MergedByHand, ALateSensorIsWaitedForInEachTurn) {
  constexpr GstClockTime kLatency = 20 * GST_MSECOND;
  for (GstHarness* h : {first_.get(), second_.get()}) gst_harness_set_upstream_latency(h, kLatency);
  for (GstClockTime turn = 0; turn < 5; ++turn) {
    const bool sees_nothing = turn == 3;
    Push(first_, sees_nothing ? NAN : 1, 100 * turn);
    EXPECT_TRUE(AwaitClockWait(first_.get(), 100 * turn * GST_MSECOND + kLatency)) << turn;
    EXPECT_EQ(gst_harness_buffers_in_queue(first_.get()), 0U) << turn;
    Push(second_, sees_nothing ? NAN : 2, 100 * turn);
    if (!sees_nothing) ExpectCloud({1, 2}, 100 * turn);
  }
}

/// A gap event tells downstream not to wait for a cloud.
TEST_F(MergedByHand, ATurnInWhichNoSensorSeesAnythingIsAGap) {
  for (const float x : {1.F, NAN, 1.F}) {
    Push(first_, x, 100);
    Push(second_, x, 100);
  }
  ExpectCloud({1, 1}, 100);
  ExpectCloud({1, 1}, 100);
  ExpectGap(100);
}

TEST_F(MergedByHand, NoGapComesBeforeTheFirstCloud) {
  for (const float x : {NAN, 1.F}) {
    Push(first_, x, 100);
    Push(second_, x, 100);
  }
  ExpectCloud({1, 1}, 100);
  while (const gst::EventPtr event{gst_harness_try_pull_event(first_.get())})
    EXPECT_NE(GST_EVENT_TYPE(event.get()), GST_EVENT_GAP);
}

/// Both pads receive gap events. pointcloudfilter sends such events instead of empty clouds.
TEST_F(MergedByHand, ATurnOfGapsIsAGapOfTheEarliersTime) {
  const auto push_gap = [](const Harness& h, GstClockTime time_ms) {
    ASSERT_TRUE(gst_harness_push_event(
        h.get(), gst_event_new_gap(time_ms * GST_MSECOND, 100 * GST_MSECOND)));
  };
  Push(first_, 1, 100);
  Push(second_, 2, 100);
  push_gap(first_, 230);
  push_gap(second_, 200);
  Push(first_, 1, 300);
  Push(second_, 2, 300);
  ExpectCloud({1, 2}, 100);
  ExpectCloud({1, 2}, 300);
  ExpectGap(200);
}

TEST_F(MergedByHand, ALateFirstSensorStillGivesTheFields) {
  for (GstHarness* h : {first_.get(), second_.get()})
    gst_harness_set_upstream_latency(h, 20 * GST_MSECOND);
  gst_harness_set_src_caps_str(second_.get(),
                               "application/x-pointcloud2,width=1,height=1,point-step=16,"
                               "fields=(string)\"x:F32:0,y:F32:4,z:F32:8,intensity:F32:12\","
                               "is-bigendian=false,is-dense=true");
  Push(first_, 1, 0);
  for (GstClockTime turn = 0; turn < 2; ++turn) {
    const float point[4] = {2, 1, 0, 99};
    GstBuffer* buffer = gst_buffer_new_memdup(point, sizeof point);
    GST_BUFFER_PTS(buffer) = turn * 100 * GST_MSECOND;
    GST_BUFFER_DURATION(buffer) = 100 * GST_MSECOND;
    gst_lidar_buffer_set_capture_time(buffer, (1'000'000 + turn * 100) * GST_MSECOND);
    ASSERT_EQ(gst_harness_push(second_.get(), buffer), GST_FLOW_OK);
    if (turn == 0) ExpectCloud({1, 2}, 0);
  }
  ASSERT_TRUE(gst_harness_crank_single_clock_wait(first_.get()));
  ExpectCloud({2}, 100);
}

TEST_F(MergedByHand, AScanBehindOneOfAnEarlierTurnHasItsOwnTime) {
  const Harness late(gst_harness_new_with_element(element_.get(), "sink_2", nullptr));
  gst_harness_set_src_caps_str(late.get(), kCaps);
  for (GstHarness* h : {first_.get(), second_.get(), late.get()})
    gst_harness_set_upstream_latency(h, 20 * GST_MSECOND);
  gst_harness_query_latency(first_.get());  // only a pad that is known to be live queues two clouds
  Push(first_, 1, 100);
  Push(first_, 2, 200);
  Push(second_, 3, 200);
  ASSERT_TRUE(gst_harness_crank_single_clock_wait(first_.get()));
  ExpectCloud({2, 3}, 200);
}

TEST_F(MergedByHand, EachPadHasItsOwnTransform) {
  const gst::PadPtr pad(gst_element_get_static_pad(element_.get(), "sink_1"));
  g_object_set(pad.get(), "transform", "5,0,0, 0,0,0", nullptr);
  Push(first_, 1, 100);
  Push(second_, 1, 100);
  ExpectCloud({1, 6}, 100);
  g_object_set(pad.get(), "transform", "", nullptr);
  Push(first_, 1, 200);
  Push(second_, 1, 200);
  ExpectCloud({1, 1}, 200);
}

TEST_F(MergedByHand, APadMayGetCloudsOfAnotherLayout) {
  Push(first_, 1, 100);
  Push(second_, 2, 100);
  ExpectCloud({1, 2}, 100);
  gst_harness_set_src_caps_str(second_.get(),
                               "application/x-pointcloud2,width=1,height=1,point-step=16,"
                               "fields=(string)\"intensity:F32:0,x:F32:4,y:F32:8,z:F32:12\","
                               "is-bigendian=false,is-dense=true");
  const float point[4] = {99, 5, 1, 0};
  GstBuffer* buffer = gst_buffer_new_memdup(point, sizeof point);
  GST_BUFFER_PTS(buffer) = 200 * GST_MSECOND;
  GST_BUFFER_DURATION(buffer) = 100 * GST_MSECOND;
  ASSERT_EQ(gst_harness_push(second_.get(), buffer), GST_FLOW_OK);
  Push(first_, 3, 200);
  ExpectCloud({3, 5}, 200);
}

TEST_F(MergedByHand, AGapOfASensorLeavesTheCloudOfTheOther) {
  ASSERT_TRUE(gst_harness_push_event(second_.get(),
                                     gst_event_new_gap(100 * GST_MSECOND, 100 * GST_MSECOND)));
  Push(first_, 1, 100);
  ExpectCloud({1}, 100);
}

TEST_F(MergedByHand, ASecondRunBeginsWithItsCaps) {
  for (int run = 0; run < 2; ++run) {
    for (GstHarness* h : {first_.get(), second_.get()}) {
      gst_pad_push_event(h->srcpad, gst_event_new_stream_start("run"));
      gst_harness_set_src_caps_str(h, kCaps);
      gst_pad_push_event(h->srcpad, NewSegment());
    }
    Push(first_, 1, 100);
    Push(second_, 2, 100);
    ExpectCloud({1, 2}, 100);
    int caps = 0;
    while (const gst::EventPtr event{gst_harness_try_pull_event(first_.get())})
      caps += GST_EVENT_TYPE(event.get()) == GST_EVENT_CAPS ? 1 : 0;
    EXPECT_EQ(caps, 1) << run;
    gst_element_set_state(element_.get(), GST_STATE_NULL);
    gst_element_set_state(element_.get(), GST_STATE_PLAYING);
  }
}

TEST_F(MergedByHand, ASecondRunForgetsTheFieldsOfTheFirst) {
  gst_harness_set_src_caps_str(first_.get(),
                               "application/x-pointcloud2,width=1,height=1,point-step=16,"
                               "fields=(string)\"x:F32:0,y:F32:4,z:F32:8,intensity:F32:12\"");
  gst_pad_push_event(second_->srcpad, gst_event_new_eos());
  const float point[4] = {1, 1, 1, 99};
  GstBuffer* buffer = gst_buffer_new_memdup(point, sizeof point);
  GST_BUFFER_PTS(buffer) = 0;
  ASSERT_EQ(gst_harness_push(first_.get(), buffer), GST_FLOW_OK);
  gst_buffer_unref(gst_harness_pull(first_.get()));
  gst_element_set_state(element_.get(), GST_STATE_NULL);
  gst_element_set_state(element_.get(), GST_STATE_PLAYING);
  for (GstHarness* h : {first_.get(), second_.get()}) {
    gst_pad_set_active(h->srcpad, FALSE);  // makes the pad forget its caps
    gst_pad_set_active(h->srcpad, TRUE);
    gst_pad_push_event(h->srcpad, gst_event_new_stream_start("run"));
  }
  gst_pad_push_event(first_->srcpad, gst_event_new_eos());
  gst_harness_set_src_caps_str(second_.get(), kCaps);
  gst_pad_push_event(second_->srcpad, NewSegment());
  Push(second_, 2, 100);
  ExpectCloud({2}, 100);
}

TEST_F(MergedByHand, APadThatGoesIsToldOf) {
  std::string gone;
  const gulong handler =
      g_signal_connect(element_.get(), "child-removed",
                       G_CALLBACK(+[](GstChildProxy*, GObject*, gchar* name, gpointer to) {
                         *static_cast<std::string*>(to) += name;
                       }),
                       &gone);
  const gst::PadPtr pad(gst_element_request_pad_simple(element_.get(), "sink_7"));
  gst_element_release_request_pad(element_.get(), pad.get());
  EXPECT_EQ(gone, "sink_7");
  g_signal_handler_disconnect(element_.get(), handler);
}

TEST_F(MergedByHand, WarnsOfSlicesOnce) {
  const ElementBus bus(element_.get());
  for (guint i = 0; i < 3; ++i) {
    const float xyz[3] = {1, 1, 0};
    GstBuffer* buffer = gst_buffer_new_memdup(xyz, sizeof xyz);
    GST_BUFFER_PTS(buffer) = i * 100 * GST_MSECOND;
    GST_BUFFER_DURATION(buffer) = 100 * GST_MSECOND;
    const GstLidarSlice slice{0, i, 4, 0};
    gst_lidar_buffer_set_slice(buffer, &slice);
    ASSERT_EQ(gst_harness_push(first_.get(), buffer), GST_FLOW_OK);
    Push(second_, 2, i * 100);
    gst_buffer_unref(gst_harness_pull(first_.get()));
  }
  EXPECT_EQ(bus.Texts(GST_MESSAGE_WARNING).size(), 1U);
}

TEST_F(MergedByHand, PadsAreChildrenByTheirOrder) {
  EXPECT_EQ(gst_child_proxy_get_children_count(GST_CHILD_PROXY(element_.get())), 2U);
  for (guint i = 0; i < 2; ++i) {
    GObject* child = gst_child_proxy_get_child_by_index(GST_CHILD_PROXY(element_.get()), i);
    ASSERT_NE(child, nullptr);
    EXPECT_EQ(GST_PAD_NAME(child), "sink_" + std::to_string(i));
    g_object_unref(child);
  }
  EXPECT_EQ(gst_child_proxy_get_child_by_name(GST_CHILD_PROXY(element_.get()), "src"), nullptr);
}

}  // namespace
}  // namespace lidar::test
