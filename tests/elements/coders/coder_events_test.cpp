// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of how coders handle events before the first slice and after a flush.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/elements/coders/coder_harness.h"
#include "tests/support/element_bus.h"

namespace lidar::gst {
namespace {

/// A decoder without an encoder, and slices and caps that the test pushes to it.
class LoneDecoder : public ::testing::TestWithParam<CoderCase> {
 protected:
  static constexpr guint kSlices = 4;

  LoneDecoder() {
    const SensorModel model = test::RoomSensor();
    const Harness encoder = Encoder(GetParam());
    SetCaps(encoder.get(), OrganisedInfo(model, 64));
    for (guint i = 0; i < kSlices; ++i)
      slices_.emplace_back(gst_harness_push_and_pull(
          encoder.get(), OrganisedBuffer(model, 64, {0, i, kSlices, 64 * i})));
    caps_.reset(gst_pad_get_current_caps(encoder->sinkpad));
    h_.reset(gst_harness_new(GetParam().decoder));
    // The flag is only set because this was the first buffer of the encoder's pad.
    gst_buffer_unset_flags(slices_[0].get(), GST_BUFFER_FLAG_DISCONT);
  }
  void SetSrcCaps() { gst_harness_set_src_caps(h_.get(), gst_caps_ref(caps_.get())); }
  GstFlowReturn Push(guint index) {
    return gst_harness_push(h_.get(), gst_buffer_copy_deep(slices_[index].get()));
  }
  std::vector<EventPtr> TakeEvents() {
    std::vector<EventPtr> events;
    while (EventPtr event{gst_harness_try_pull_event(h_.get())}) events.push_back(std::move(event));
    return events;
  }

  Harness h_;
  std::vector<BufferPtr> slices_;
  CapsPtr caps_;
};

TEST_P(LoneDecoder, MarksTheFirstCloudBehindAFlushAndNoOther) {
  SetSrcCaps();
  for (int round = 0; round < 2; ++round) {
    for (guint i = 0; i < kSlices; ++i) {
      ASSERT_EQ(Push(i), GST_FLOW_OK);
      const BufferPtr cloud(gst_harness_try_pull(h_.get()));
      ASSERT_TRUE(cloud);
      EXPECT_EQ(GST_BUFFER_IS_DISCONT(cloud.get()), round > 0 && i == 0) << round << ' ' << i;
    }
    test::Flush(h_.get());
  }
}

TEST_P(LoneDecoder, PassesItsSegmentAndTagsOnBeforeAnEndWithoutASlice) {
  SetSrcCaps();
  gst_harness_push_event(h_.get(), gst_event_new_tag(gst_tag_list_new(
                                       GST_TAG_TITLE, "title", static_cast<void*>(nullptr))));
  gst_harness_push_event(h_.get(), gst_event_new_eos());
  std::vector<GstEventType> types;
  for (const EventPtr& event : TakeEvents()) types.push_back(GST_EVENT_TYPE(event.get()));
  EXPECT_EQ(types, (std::vector<GstEventType>{GST_EVENT_STREAM_START, GST_EVENT_SEGMENT,
                                              GST_EVENT_TAG, GST_EVENT_EOS}));
}

TEST_P(LoneDecoder, HoldsTheLatestStickyEventOfEachNameUntilTheFirstSlice) {
  SetSrcCaps();
  TakeEvents();
  guint number = 0;
  for (const char* name : {"one", "other", "one"})
    gst_harness_push_event(
        h_.get(),
        gst_event_new_custom(GST_EVENT_CUSTOM_DOWNSTREAM_STICKY,
                             gst_structure_new(name, "number", G_TYPE_UINT, number++, nullptr)));
  EXPECT_TRUE(TakeEvents().empty());
  ASSERT_EQ(Push(0), GST_FLOW_OK);
  std::vector<std::string> seen;
  for (const EventPtr& event : TakeEvents()) {
    if (GST_EVENT_TYPE(event.get()) != GST_EVENT_CUSTOM_DOWNSTREAM_STICKY) continue;
    const GstStructure* s = gst_event_get_structure(event.get());
    guint at = 0;
    ASSERT_TRUE(gst_structure_get_uint(s, "number", &at));
    seen.push_back(gst_structure_get_name(s) + std::to_string(at));
  }
  EXPECT_EQ(seen, (std::vector<std::string>{"other1", "one2"}));
}

TEST_P(LoneDecoder, TakesASliceOfTheFutureForNew) {
  SetSrcCaps();
  const auto now = static_cast<GstClockTime>(g_get_real_time()) * GST_USECOND;
  gst_lidar_buffer_set_capture_time(slices_[0].get(), now + 3'600 * GST_SECOND);
  ASSERT_EQ(Push(0), GST_FLOW_OK);
  guint64 age = 1;
  g_object_get(h_->element, "age", &age, nullptr);
  EXPECT_EQ(age, 0U);
  EXPECT_EQ(test::StatOf(h_->element, "age"), 0U);
}

/// Returns a copy of `caps` with fields that no coder accepts.
CapsPtr WithBadFields(const GstCaps* caps) {
  CapsPtr bad(gst_caps_copy(caps));
  gst_caps_set_simple(bad.get(), "fields", G_TYPE_STRING, "x:F64:0,y:F64:8,z:F64:16", "point-step",
                      G_TYPE_INT, 24, nullptr);
  return bad;
}

/// Expects one error each time that bad caps follow good caps.
void ExpectAnErrorEachTime(GstHarness* h, GstCaps* good) {
  const test::ElementBus bus(h->element);
  const CapsPtr bad = WithBadFields(good);
  for (int round = 0; round < 3; ++round) {
    for (int again = 0; again < 2; ++again)
      gst_harness_push_event(h, gst_event_new_caps(bad.get()));
    EXPECT_EQ(bus.Texts(GST_MESSAGE_ERROR).size(), 1U) << round;
    gst_harness_push_event(h, gst_event_new_caps(good));
    EXPECT_TRUE(bus.Texts(GST_MESSAGE_ERROR).empty()) << round;
  }
}

TEST_P(LoneDecoder, TellsOfBadCapsAgainBehindGoodOnes) {
  SetSrcCaps();
  ExpectAnErrorEachTime(h_.get(), caps_.get());
  EXPECT_EQ(Push(0), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_buffers_received(h_.get()), 1U);
}

TEST_P(LoneDecoder, HasAnEncoderThatTellsOfBadCapsAgainBehindGoodOnes) {
  const Harness encoder = Encoder(GetParam());
  const CloudInfo info = OrganisedInfo(test::RoomSensor(), 64);
  SetCaps(encoder.get(), info);
  const CapsPtr caps(info.ToCaps());
  ExpectAnErrorEachTime(encoder.get(), caps.get());
}

INSTANTIATE_TEST_SUITE_P(Coders, LoneDecoder, ::testing::ValuesIn(AllCoders()),
                         [](const auto& c) { return c.param.name; });

}  // namespace
}  // namespace lidar::gst
