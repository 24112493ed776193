// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of the pad on which a source outputs the samples of an inertial measurement unit: its
// events, times, queries and flushes.
#include "gst/common/imu_pad.h"

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <vector>

#include "gst/common/element_class.h"
#include "gst/common/latency.h"
#include "gst/common/refs.h"

namespace {

/// A source that does not push anything by itself.
struct ImuSource {
  GstBaseSrc parent;
};
using ImuSourceClass = GstBaseSrcClass;
GType imu_source_get_type();
G_DEFINE_TYPE(ImuSource, imu_source, GST_TYPE_BASE_SRC)

void imu_source_init(ImuSource* self) {
  gst_base_src_set_format(GST_BASE_SRC(self), GST_FORMAT_TIME);
}
void imu_source_class_init(ImuSourceClass* klass) {
  lidar::gst::Describe(klass, {"Source", "Source", "Source"},
                       {{"src", GST_PAD_SRC, "ANY"},
                        {"imu", GST_PAD_SRC, GST_LIDAR_IMU_MEDIA_TYPE, GST_PAD_SOMETIMES}});
}

}  // namespace

namespace lidar::gst {
namespace {

constexpr ImuToSensor kHere = {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
constexpr ImuToSensor kThere = {1, 0, 0, 0.7, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

class ImuPads : public ::testing::Test {
 protected:
  void SetUp() override {
    gst_lidar_init();
    source_.reset(GST_ELEMENT(
        gst_object_ref_sink(g_object_new(imu_source_get_type(), "name", "source", nullptr))));
    GstPad* clouds = GST_BASE_SRC_PAD(source_.get());
    // Replaces the function that would start a task, because the task would push clouds.
    gst_pad_set_activatemode_function(
        clouds, [](GstPad*, GstObject*, GstPadMode, gboolean) -> gboolean { return TRUE; });
    gst_pad_set_active(clouds, TRUE);
    GstEvent* start = gst_event_new_stream_start("clouds");
    gst_event_set_group_id(start, 4'321);
    gst_pad_push_event(clouds, start);
    g_signal_connect(source_.get(), "pad-added", G_CALLBACK(OnPad), this);
    pad_.emplace(GST_BASE_SRC(source_.get()));
  }
  void TearDown() override {
    pad_.reset();
    EXPECT_EQ(PadPtr(gst_element_get_static_pad(source_.get(), "imu")), nullptr);
  }
  /// Links the new pad. Notes whether the pad already had a segment when it was added.
  static void OnPad(GstElement*, GstPad* pad, gpointer self) {
    auto* test = static_cast<ImuPads*>(self);
    test->had_segment_ = EventPtr(gst_pad_get_sticky_event(pad, GST_EVENT_SEGMENT, 0)) != nullptr;
    static GstStaticPadTemplate any =
        GST_STATIC_PAD_TEMPLATE("sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS_ANY);
    test->sink_.reset(GST_PAD(gst_object_ref_sink(gst_pad_new_from_static_template(&any, "sink"))));
    GstPad* sink = test->sink_.get();
    gst_pad_set_element_private(sink, test);
    gst_pad_set_chain_function(sink, [](GstPad* p, GstObject*, GstBuffer* buffer) {
      static_cast<ImuPads*>(gst_pad_get_element_private(p))->buffers_.emplace_back(buffer);
      return GST_FLOW_OK;
    });
    gst_pad_set_event_function(sink, [](GstPad* p, GstObject*, GstEvent* event) -> gboolean {
      ++static_cast<ImuPads*>(gst_pad_get_element_private(p))->events_[GST_EVENT_TYPE(event)];
      gst_event_unref(event);
      return TRUE;
    });
    gst_pad_set_active(sink, TRUE);
    EXPECT_EQ(gst_pad_link(pad, sink), GST_PAD_LINK_OK);
  }

  void Push(GstClockTime pts, const ImuToSensor& imu_to_sensor = kHere, std::size_t samples = 1) {
    ImuSample sample;
    sample.time = Time{Duration{static_cast<gint64>(1'000 + pts)}};
    pad_->Push(std::vector<ImuSample>(samples, sample), imu_to_sensor, pts);
  }
  PadPtr Imu() const { return PadPtr(gst_element_get_static_pad(source_.get(), "imu")); }
  std::vector<GstClockTime> TakeTimes() {
    std::vector<GstClockTime> times;
    for (const BufferPtr& buffer : std::exchange(buffers_, {}))
      times.push_back(GST_BUFFER_PTS(buffer.get()));
    return times;
  }
  using Times = std::vector<GstClockTime>;

  ElementPtr source_;
  std::optional<ImuPad> pad_;
  PadPtr sink_;
  bool had_segment_ = false;
  std::vector<BufferPtr> buffers_;
  std::map<GstEventType, int> events_;
};

TEST_F(ImuPads, ComeWithTheFirstSampleInTheGroupOfTheClouds) {
  pad_->Push({}, kHere, 0);
  EXPECT_FALSE(Imu()) << "there is no sample";
  Push(5, kHere, 3);
  ASSERT_TRUE(Imu());
  EXPECT_TRUE(had_segment_);
  const EventPtr start(gst_pad_get_sticky_event(Imu().get(), GST_EVENT_STREAM_START, 0));
  guint group = 0;
  ASSERT_TRUE(gst_event_parse_group_id(start.get(), &group));
  EXPECT_EQ(group, 4'321U);
  const gchar* stream = nullptr;
  gst_event_parse_stream_start(start.get(), &stream);
  EXPECT_STRNE(stream, "clouds");
  ASSERT_EQ(buffers_.size(), 1U);
  EXPECT_EQ(gst_buffer_get_size(buffers_[0].get()), 3 * kImuSampleSize);
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(buffers_[0].get()), 1'005U);
  EXPECT_EQ(TakeTimes(), Times{5});
}

TEST_F(ImuPads, HaveCapsThatFollowThePlaceOfTheUnit) {
  const auto caps = [&] { return CapsPtr(gst_pad_get_current_caps(Imu().get())); };
  for (const ImuToSensor& place : {kHere, kHere, kThere, kHere}) {
    Push(0, place);
    EXPECT_TRUE(gst_caps_is_equal(caps().get(), ImuCaps(place).get()));
  }
  EXPECT_EQ(TakeTimes().size(), 4U);
}

TEST_F(ImuPads, GiveTimesThatNeverGoBackWithinASegmentAndNoneBeforeIt) {
  for (const GstClockTime pts : {20U, 10U, 30U}) Push(pts);
  EXPECT_EQ(TakeTimes(), (Times{20, 20, 30}));
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  segment.start = 12;
  pad_->SetSegment(segment);
  for (const GstClockTime pts : {11U, 12U, 15U}) Push(pts);
  EXPECT_EQ(TakeTimes(), (Times{12, 15}));
  const EventPtr event(gst_pad_get_sticky_event(Imu().get(), GST_EVENT_SEGMENT, 0));
  const GstSegment* sent = nullptr;
  gst_event_parse_segment(event.get(), &sent);
  EXPECT_EQ(sent->start, 12U);
}

TEST_F(ImuPads, DropWhatComesDuringAFlush) {
  Push(1);
  pad_->StopFlush();
  EXPECT_EQ(events_[GST_EVENT_FLUSH_STOP], 0) << "none has begun";
  pad_->StartFlush(77);
  Push(2);
  pad_->StopFlush();
  pad_->StopFlush();
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  pad_->SetSegment(segment);
  Push(3);
  EXPECT_EQ(TakeTimes(), (Times{1, 3}));
  EXPECT_EQ(events_[GST_EVENT_FLUSH_START], 1);
  EXPECT_EQ(events_[GST_EVENT_FLUSH_STOP], 1);
  EXPECT_EQ(events_[GST_EVENT_SEGMENT], 2);
}

TEST_F(ImuPads, AreAsLiveAsTheirSourceAndHoldNothingBack) {
  Push(1);
  for (const bool live : {false, true}) {
    gst_base_src_set_live(GST_BASE_SRC(source_.get()), live);
    const QueryPtr query(gst_query_new_latency());
    ASSERT_TRUE(gst_pad_query(Imu().get(), query.get()));
    const Latency latency = ReadLatency(query.get());
    EXPECT_EQ(latency.live, live);
    EXPECT_EQ(latency.min, 0U);
    EXPECT_EQ(latency.max, GST_CLOCK_TIME_NONE);
  }
}

TEST_F(ImuPads, EndWithTheClouds) {
  Push(1);
  EXPECT_EQ(events_[GST_EVENT_EOS], 0);
  gst_pad_push_event(GST_BASE_SRC_PAD(source_.get()),
                     gst_event_new_segment_done(GST_FORMAT_TIME, 1));
  EXPECT_EQ(events_[GST_EVENT_SEGMENT_DONE], 1);
  gst_pad_push_event(GST_BASE_SRC_PAD(source_.get()), gst_event_new_eos());
  EXPECT_EQ(events_[GST_EVENT_EOS], 1);
}

}  // namespace
}  // namespace lidar::gst
