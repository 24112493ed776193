// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of the properties that all coders have in common.
#include <gtest/gtest.h>

#include <map>
#include <tuple>
#include <utility>

#include "gst/lidar/gstlidardecoder.h"
#include "tests/elements/coders/coder_harness.h"
#include "tests/elements/coders/stopped_clock.h"
#include "tests/support/element_bus.h"
#include "tests/support/patience.h"

namespace lidar::gst {
namespace {

constexpr CoderCase kDracoPlain{"draco_plain", "dracoenc range-coder=draco", "dracodec"};

struct ErrorCase {
  CoderCase coder;
  std::uint32_t unit_mm;
  double max_error_m;
};
void PrintTo(const ErrorCase& c, std::ostream* out) { *out << c.coder.name; }
class OrganisedScans : public ::testing::TestWithParam<ErrorCase> {};

TEST_P(OrganisedScans, ComeBackWithinTheErrorSliceBySlice) {
  const ErrorCase& c = GetParam();
  const SensorModel model = test::RoomSensor(32, c.unit_mm);
  const Harness h = Codec(c.coder, "max-error=" + std::to_string(c.max_error_m));
  SetCaps(h.get(), OrganisedInfo(model, 64));
  for (guint i = 0; i < 8; ++i) {
    GstBuffer* input = OrganisedBuffer(model, 64, {7, i, 8, 64 * i});
    const auto before = PointsOf(input, 20);
    ASSERT_EQ(gst_harness_push(h.get(), input), GST_FLOW_OK);
    const BufferPtr output(gst_harness_pull(h.get()));
    EXPECT_LE(LargestDistance(before, PointsOf(output.get(), 20)), c.max_error_m + 1e-5);
    GstLidarSlice slice{};
    ASSERT_TRUE(gst_lidar_buffer_get_slice(output.get(), &slice));
    EXPECT_EQ(slice.scan_id, 7U);
    EXPECT_EQ(slice.slice_index, i);
    EXPECT_EQ(slice.first_column, 64 * i);
    EXPECT_EQ(GST_BUFFER_PTS(output.get()), (56 + i) * 12'500 * GST_USECOND);
    EXPECT_EQ(gst_lidar_buffer_get_capture_time(output.get()),
              1'700'000'000 * GST_SECOND + (56 + i) * 12'500 * GST_USECOND);
  }
  const CapsPtr out(gst_pad_get_current_caps(h->sinkpad));
  const auto info = CloudInfo::FromCaps(out.get());
  ASSERT_TRUE(info);
  EXPECT_EQ(info->width, 64U);
  EXPECT_EQ(info->height, 32U);
  EXPECT_EQ(info->fields, test::OrganisedLayout().fields);
  EXPECT_TRUE(info->sensor_model);
}
INSTANTIATE_TEST_SUITE_P(Lidar, OrganisedScans,
                         ::testing::Values(ErrorCase{kLidar, 1, 0.02}, ErrorCase{kLidar, 8, 0.02},
                                           ErrorCase{kLidar, 1, 0.0003}));
#ifdef HAVE_DRACO
INSTANTIATE_TEST_SUITE_P(Draco, OrganisedScans,
                         ::testing::Values(ErrorCase{kDracoPlain, 1, 0.02},
                                           ErrorCase{kDracoPlain, 8, 0.02},
                                           ErrorCase{kDraco, 8, 0.05},
                                           ErrorCase{kDracoPlain, 1, 0.0015},
                                           ErrorCase{kDracoPlain, 8, 0.001}));
#endif

TEST_P(EitherCoder, GivesGapsBackAsZeros) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Codec(GetParam());
  SetCaps(h.get(), OrganisedInfo(model, 512));
  GstBuffer* input = OrganisedBuffer(model, 512, {0, 0, 1, 0});
  const auto before = PointsOf(input, 20);
  const BufferPtr output(gst_harness_push_and_pull(h.get(), input));
  const auto after = PointsOf(output.get(), 20);
  ASSERT_EQ(after.size(), before.size());
  std::size_t gaps = 0;
  for (std::size_t i = 0; i < before.size(); i += 3) {
    const bool gap = before[i] == 0 && before[i + 1] == 0 && before[i + 2] == 0;
    gaps += gap ? 1 : 0;
    EXPECT_EQ(gap, after[i] == 0 && after[i + 1] == 0 && after[i + 2] == 0);
  }
  EXPECT_GT(gaps, 300U);
}

TEST_P(EitherCoder, DropsAndCountsADamagedSliceAndGoesOn) {
  const SensorModel model = test::RoomSensor();
  const Harness enc = Encoder(GetParam());
  const Harness dec(gst_harness_new(GetParam().decoder));
  SetCaps(enc.get(), OrganisedInfo(model, 64));
  std::vector<BufferPtr> slices;
  for (guint i = 0; i < 3; ++i) {
    slices.emplace_back(
        gst_harness_push_and_pull(enc.get(), OrganisedBuffer(model, 64, {0, i, 8, 64 * i})));
  }
  gst_harness_set_src_caps(dec.get(), gst_pad_get_current_caps(enc->sinkpad));
  BufferPtr damaged(gst_buffer_copy_deep(slices[1].get()));
  {
    BufferMap map(damaged.get(), GST_MAP_WRITE);
    map.data()[map.size() / 2] ^= 0xFF;
    map.data()[0] = 0xF0;
  }
  EXPECT_EQ(gst_harness_push(dec.get(), slices[0].release()), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_push(dec.get(), damaged.release()), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_push(dec.get(), slices[2].release()), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_buffers_received(dec.get()), 2U);
  EXPECT_EQ(test::StatOf(dec->element, "slices-dropped"), 1U);
  gst_buffer_unref(gst_harness_pull(dec.get()));
  const BufferPtr after(gst_harness_pull(dec.get()));
  EXPECT_TRUE(GST_BUFFER_IS_DISCONT(after.get()));
}

TEST_P(EitherCoder, SaysFlushingWhereTheFirstSliceComesWhileItStops) {
  const SensorModel model = test::RoomSensor();
  const Harness enc = Encoder(GetParam());
  const Harness dec(gst_harness_new(GetParam().decoder));
  SetCaps(enc.get(), OrganisedInfo(model, 64));
  GstBuffer* slice = gst_harness_push_and_pull(enc.get(), OrganisedBuffer(model, 64, {0, 0, 8, 0}));
  gst_harness_set_src_caps(dec.get(), gst_pad_get_current_caps(enc->sinkpad));
  const PadPtr src(gst_element_get_static_pad(dec->element, "src"));
  gst_pad_set_active(src.get(), FALSE);
  EXPECT_EQ(gst_harness_push(dec.get(), slice), GST_FLOW_FLUSHING);
}

class ExtremeSettings : public ::testing::TestWithParam<std::tuple<CoderCase, const char*>> {};
TEST_P(ExtremeSettings, NeverBreakTheErrorBound) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Codec(std::get<0>(GetParam()), std::get<1>(GetParam()));
  SetCaps(h.get(), OrganisedInfo(model, 64));
  for (guint scan = 0; scan < 3; ++scan) {
    for (guint i = 0; i < 8; ++i) {
      GstBuffer* input = OrganisedBuffer(model, 64, {scan, i, 8, 64 * i});
      const auto before = PointsOf(input, 20);
      ASSERT_EQ(gst_harness_push(h.get(), input), GST_FLOW_OK);
      const BufferPtr output(gst_harness_try_pull(h.get()));
      if (!output) continue;
      const CapsPtr out(gst_pad_get_current_caps(h->sinkpad));
      EXPECT_LE(LargestDistance(before,
                                PointsOf(output.get(), CloudInfo::FromCaps(out.get())->point_step)),
                0.02 + 1e-5);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(
    All, ExtremeSettings,
    ::testing::Combine(::testing::ValuesIn(RangeCoders()),
                       ::testing::Values("bitrate=1", "bitrate=4000000000",
                                         "quantization-step=0.0000001", "quantization-step=1000",
                                         "intensity-bits=0", "intensity-bits=1", "threads=64",
                                         "rate-model=paper bitrate=500000")));

TEST_P(EitherCoder, GivesTheSameCloudWithMoreThreads) {
  const SensorModel model = test::RoomSensor(128);
  std::vector<std::vector<float>> clouds;
  for (const char* settings : {"threads=1", "threads=3"}) {
    const Harness h = Codec(GetParam(), settings);
    SetCaps(h.get(), OrganisedInfo(model, 512));
    const BufferPtr output(
        gst_harness_push_and_pull(h.get(), OrganisedBuffer(model, 512, {0, 0, 1, 100})));
    clouds.push_back(PointsOf(output.get(), 20));
  }
  EXPECT_EQ(clouds[0], clouds[1]);
}

/// Each thread codes a block of its own. Each block has a header, so more threads need more bytes.
TEST_P(EitherCoder, DividesALargeCloudAmongItsThreads) {
  const SensorModel model = test::RoomSensor(128);
  gsize before = 0;
  for (const char* settings : {"threads=1", "threads=3"}) {
    const Harness h = Encoder(GetParam(), settings);
    SetCaps(h.get(), OrganisedInfo(model, 512));
    const BufferPtr output(
        gst_harness_push_and_pull(h.get(), OrganisedBuffer(model, 512, {0, 0, 1, 0})));
    EXPECT_GT(gst_buffer_get_size(output.get()), before);
    before = gst_buffer_get_size(output.get());
  }
}

TEST_P(AnyCoder, DropsWhatTakesMoreProcessorTimeThanAllowed) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Codec(GetParam());
  const test::ElementBus bus(h->element);
  SetCaps(h.get(), OrganisedInfo(model, 64));
  const ElementPtr dec(gst_bin_get_by_name(GST_BIN(h->element), "dec"));
  const auto push = [&](guint scan) {
    for (guint i = 0; i < 8; ++i)
      gst_harness_push(h.get(), OrganisedBuffer(model, 64, {scan, i, 8, 64 * i}));
  };
  push(0);
  EXPECT_EQ(test::StatOf(dec.get(), "slices-over-load"), 0U);
  g_object_set(dec.get(), "max-decode-load", 1e-6, "stats-interval", guint64{1}, nullptr);
  push(1);
  push(2);
  EXPECT_GE(test::StatOf(dec.get(), "slices-over-load"), 15U) << "a microsecond a second";
  EXPECT_EQ(test::StatOf(dec.get(), "slices-dropped"), test::StatOf(dec.get(), "slices-over-load"));
  unsigned warnings = 0;
  guint64 told = 0;
  while (const MessagePtr message = bus.Pop(GST_MESSAGE_WARNING | GST_MESSAGE_ELEMENT)) {
    if (GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_WARNING)
      ++warnings;
    else
      gst_structure_get_uint64(gst_message_get_structure(message.get()), "slices-over-load", &told);
  }
  EXPECT_EQ(warnings, 1U);
  EXPECT_GE(told, 14U) << "stats come although nothing is decoded";
  g_object_set(dec.get(), "max-decode-load", 0.0, nullptr);
  push(3);
  EXPECT_EQ(test::StatOf(dec.get(), "slices-dropped"), test::StatOf(dec.get(), "slices-over-load"));
}

TEST_P(AnyCoder, WhatItDecodedWithoutALimitDoesNotCountAgainstALaterOne) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Codec(GetParam());
  SetCaps(h.get(), OrganisedInfo(model, 64));
  const ElementPtr dec(gst_bin_get_by_name(GST_BIN(h->element), "dec"));
  const test::StoppedClock clock;
  for (guint i = 0; i < 8; ++i)
    gst_harness_push(h.get(), OrganisedBuffer(model, 64, {0, i, 8, 64 * i}));
  g_object_set(dec.get(), "max-decode-load", 1.0, nullptr);
  gst_harness_push(h.get(), OrganisedBuffer(model, 64, {1, 0, 8, 0}));
  EXPECT_EQ(test::StatOf(dec.get(), "slices-over-load"), 0U);
  EXPECT_EQ(gst_harness_buffers_received(h.get()), 9U);
}

TEST_P(AnyCoder, SurvivesFlushEosAndStateCycles) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Codec(GetParam());
  for (int cycle = 0; cycle < 3; ++cycle) {
    SetCaps(h.get(), OrganisedInfo(model, 64));
    const BufferPtr first(
        gst_harness_push_and_pull(h.get(), OrganisedBuffer(model, 64, {0, 0, 8, 0})));
    ASSERT_TRUE(first);
    ASSERT_TRUE(gst_harness_push_event(h.get(), gst_event_new_flush_start()));
    ASSERT_TRUE(gst_harness_push_event(h.get(), gst_event_new_flush_stop(TRUE)));
    ASSERT_TRUE(gst_harness_push_event(h.get(), test::NewSegment()));
    const BufferPtr second(
        gst_harness_push_and_pull(h.get(), OrganisedBuffer(model, 64, {1, 0, 8, 0})));
    EXPECT_TRUE(GST_BUFFER_IS_DISCONT(second.get()));
    EXPECT_TRUE(gst_harness_push_event(h.get(), gst_event_new_eos()));
    ASSERT_EQ(gst_element_set_state(h->element, GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
    gst_harness_play(h.get());
    gst_harness_push_event(h.get(), gst_event_new_stream_start("again"));
  }
}

TEST_P(AnyCoder, ScansBeforeAndAfterAFlushAreTwo) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Codec(GetParam());
  SetCaps(h.get(), OrganisedInfo(model, 64));
  const ElementPtr enc(gst_bin_get_by_name(GST_BIN(h->element), "enc"));
  for (guint i = 0; i < 2; ++i)
    gst_harness_push(h.get(), OrganisedBuffer(model, 64, {7, i, 8, 64 * i}));
  EXPECT_EQ(test::StatOf(enc.get(), "scans-in"), 1U);
  test::Flush(h.get());
  gst_harness_push(h.get(), OrganisedBuffer(model, 64, {7, 2, 8, 128}));
  EXPECT_EQ(test::StatOf(enc.get(), "scans-in"), 2U);
}

class RefusedCaps : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};
TEST_P(RefusedCaps, GiveOneErrorThatSaysWhatIsMissing) {
  const auto [launch, text] = GetParam();
  const Harness h(gst_harness_new_parse(launch));
  const test::ElementBus bus(h->element);
  gst_harness_play(h.get());
  gst_harness_push_event(h.get(), gst_event_new_stream_start("refused"));
  const CapsPtr caps(gst_caps_from_string(text));
  gst_harness_push_event(h.get(), gst_event_new_caps(caps.get()));
  const MessagePtr message = bus.Pop(GST_MESSAGE_ERROR);
  ASSERT_TRUE(message);
  GError* error = nullptr;
  gst_message_parse_error(message.get(), &error, nullptr);
  EXPECT_TRUE(g_error_matches(error, GST_STREAM_ERROR, GST_STREAM_ERROR_FORMAT));
  g_error_free(error);
  // GStreamer may send the same caps again. The element must not post its error a second time.
  gst_harness_push_event(h.get(), gst_event_new_caps(caps.get()));
  EXPECT_FALSE(bus.Pop(GST_MESSAGE_ERROR));
}
INSTANTIATE_TEST_SUITE_P(
    Lidar, RefusedCaps,
    ::testing::Values(std::pair("lidarenc",
                                "application/x-pointcloud2,width=4,height=1,point-step=12,"
                                "fields=(string)\"x:F32:0,z:F32:4,y:F32:8\""),
                      std::pair("lidarenc",
                                "application/x-pointcloud2,width=4,point-step=4,"
                                "fields=(string)\"x:F32:0\""),
                      std::pair("lidardec",
                                "application/x-lidar-slice,geometry=(string)xyz,"
                                "fields=(string)\"x:F32:1000,y:F32:1004,z:F32:1008\""),
                      std::pair("lidardec",
                                "application/x-lidar-slice,geometry=(string)range,"
                                "fields=(string)\"x:F32:0,y:F32:4,z:F32:8\"")));
#ifdef HAVE_DRACO
constexpr const char* kXyzCaps =
    "application/x-pointcloud2,width=4,height=1,point-step=12,fields=(string)\"x:F32:0,y:F32:4,"
    "z:F32:8\"";
INSTANTIATE_TEST_SUITE_P(
    Draco, RefusedCaps,
    ::testing::Values(std::pair("dracoenc geometry=range", kXyzCaps),
                      std::pair("dracoenc",
                                "application/x-pointcloud2,width=4,point-step=4,"
                                "fields=(string)\"x:F32:0\""),
                      std::pair("dracodec",
                                "application/x-draco,fields=(string)\"x:F64:0,y:F64:8,z:F64:16\""),
                      std::pair("dracodec",
                                "application/x-draco,geometry=(string)range,"
                                "fields=(string)\"x:F32:0,y:F32:4,z:F32:8\""),
                      std::pair("dracodec", "application/x-draco,geometry=(string)mesh")));
#endif

TEST_P(EitherCoder, RefusesASliceOfMorePointsThanItMayHave) {
  const SensorModel model = test::RoomSensor();
  CoderCase coder = GetParam();
  const std::string decoder = std::string(coder.decoder) + " max-points=2047";
  coder.decoder = decoder.c_str();
  const Harness h = Codec(coder);
  SetCaps(h.get(), OrganisedInfo(model, 64));
  EXPECT_EQ(gst_harness_push(h.get(), OrganisedBuffer(model, 64, {0, 0, 8, 0})), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_buffers_received(h.get()), 0U);
  const ElementPtr dec(gst_bin_get_by_name(GST_BIN(h->element), "dec"));
  EXPECT_EQ(test::StatOf(dec.get(), "slices-dropped"), 1U);
}

TEST_P(EitherCoder, HoldsTagsBackThroughAFlushUntilTheFirstSliceButNoGaps) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Codec(GetParam());
  SetCaps(h.get(), OrganisedInfo(model, 64));
  for (guint64 i = 0; i < 100; ++i)
    gst_harness_push_event(h.get(), gst_event_new_gap(i * GST_MSECOND, GST_MSECOND));
  for (const char* title : {"first", "second"})
    gst_harness_push_event(h.get(), gst_event_new_tag(gst_tag_list_new(
                                        GST_TAG_TITLE, title, static_cast<void*>(nullptr))));
  test::Flush(h.get());
  ASSERT_EQ(gst_harness_push(h.get(), OrganisedBuffer(model, 64, {0, 0, 8, 0})), GST_FLOW_OK);
  std::map<GstEventType, int> events;
  while (const EventPtr event{gst_harness_try_pull_event(h.get())})
    ++events[GST_EVENT_TYPE(event.get())];
  EXPECT_EQ(events[GST_EVENT_GAP], 0);
  EXPECT_EQ(events[GST_EVENT_TAG], 1);
  EXPECT_EQ(events[GST_EVENT_SEGMENT], 1);
}

TEST_P(AnyCoder, PostsItsStatsAsOftenAsAsked) {
  const SensorModel model = test::RoomSensor();
  for (const bool asked : {false, true}) {
    const Harness h = Codec(GetParam(), asked ? "stats-interval=1" : "");
    const ElementPtr dec(gst_bin_get_by_name(GST_BIN(h->element), "dec"));
    g_object_set(dec.get(), "stats-interval", guint64{asked}, nullptr);
    const test::ElementBus bus(h->element);
    SetCaps(h.get(), OrganisedInfo(model, 64));
    for (guint i = 0; i < 4; ++i)
      gst_harness_push(h.get(), OrganisedBuffer(model, 64, {0, i, 8, 64 * i}));
    std::map<std::string, guint64> slices;
    while (const MessagePtr message = bus.Pop(GST_MESSAGE_ELEMENT)) {
      const GstStructure* s = gst_message_get_structure(message.get());
      EXPECT_TRUE(gst_structure_get_uint64(s, "slices", &slices[gst_structure_get_name(s)]));
    }
    EXPECT_EQ(slices.size(), asked ? 2U : 0U);
    for (const auto& [name, count] : slices) EXPECT_GE(count, 3U) << name;
  }
}

TEST_P(AnyCoder, PostsItsStatsOnceTheIntervalHasPassed) {
  test::StoppedClock clock;
  const SensorModel model = test::RoomSensor();
  const Harness h = Encoder(GetParam(), "stats-interval=1000000000");
  const test::ElementBus bus(h->element);
  SetCaps(h.get(), OrganisedInfo(model, 64));
  for (guint i = 0; i < 7; ++i) {  // one slice every half second
    gst_harness_push(h.get(), OrganisedBuffer(model, 64, {0, i, 8, 64 * i}));
    EXPECT_EQ(bus.Pop(GST_MESSAGE_ELEMENT) != nullptr, i > 0 && i % 2 == 0) << i;
    clock.Advance(G_USEC_PER_SEC / 2);
  }
}

TEST_P(AnyCoder, TellsTheTimeOfTheLastSliceAndTheMean) {
  const test::StoppedClock clock;  // each read of the clock takes a microsecond
  const SensorModel model = test::RoomSensor();
  const Harness h = Codec(GetParam());
  SetCaps(h.get(), OrganisedInfo(model, 64));
  std::map<std::string, guint64> sums;
  for (guint i = 0; i < 5; ++i) {
    gst_harness_push(h.get(), OrganisedBuffer(model, 64, {0, i, 8, 64 * i}));
    for (const auto& [name, stat] : {std::pair("enc", std::string("encode-time")),
                                     std::pair("dec", std::string("decode-time"))}) {
      const ElementPtr element(gst_bin_get_by_name(GST_BIN(h->element), name));
      const guint64 last = test::StatOf(element.get(), stat.c_str());
      EXPECT_GE(last, GST_USECOND);
      sums[name] += last;
      EXPECT_EQ(test::StatOf(element.get(), ("mean-" + stat).c_str()), sums[name] / (i + 1)) << i;
    }
  }
}

TEST_P(AnyCoder, GivesCapsOfAnotherFrameRateThoughSlicesKeepTheirSize) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Codec(GetParam());
  CloudInfo info = OrganisedInfo(model, 64);
  for (const gint rate : {10, 20}) {
    info.framerate_n = rate;
    SetCaps(h.get(), info);
    ASSERT_EQ(gst_harness_push(h.get(), OrganisedBuffer(model, 64, {0, 0, 8, 0})), GST_FLOW_OK);
    const CapsPtr caps(gst_pad_get_current_caps(h->sinkpad));
    EXPECT_EQ(CloudInfo::FromCaps(caps.get())->framerate_n, rate);
  }
}

TEST_P(EitherCoder, DecodesASensorThatTakesThePlaceOfAnother) {
  const Harness h = Codec(GetParam());
  for (const guint beams : {32U, 16U, 32U}) {
    const SensorModel model = test::RoomSensor(beams);
    SetCaps(h.get(), OrganisedInfo(model, 64));
    GstBuffer* input = OrganisedBuffer(model, 64, {0, 0, 8, 0});
    const auto before = PointsOf(input, 20);
    ASSERT_EQ(gst_harness_push(h.get(), input), GST_FLOW_OK);
    const BufferPtr output(gst_harness_try_pull(h.get()));
    ASSERT_TRUE(output) << beams;
    EXPECT_LE(LargestDistance(before, PointsOf(output.get(), 20)), 0.02 + 1e-5);
  }
}

TEST(LidarEnc, CodesCloudsWiderThanATurnAsPoints) {
  const SensorModel model = test::RoomSensor();
  for (const guint columns : {512U, 513U}) {
    const Harness h = Encoder(kLidar);
    SetCaps(h.get(), OrganisedInfo(model, columns));
    gst_harness_push(h.get(), OrganisedBuffer(model, columns, {0, 0, 1, 0}));
    EXPECT_EQ(gst_harness_buffers_received(h.get()), 1U) << columns;
    const CapsPtr caps(gst_pad_get_current_caps(h->sinkpad));
    EXPECT_STREQ(gst_structure_get_string(gst_caps_get_structure(caps.get(), 0), "geometry"),
                 columns == 512 ? "range" : "xyz");
  }
}

INSTANTIATE_TEST_SUITE_P(Coders, EitherCoder, ::testing::ValuesIn(RangeCoders()),
                         [](const auto& c) { return c.param.name; });
INSTANTIATE_TEST_SUITE_P(Coders, AnyCoder, ::testing::ValuesIn(AllCoders()),
                         [](const auto& c) { return c.param.name; });

// If the decoder output caps without a width, the elements after it would stop.
TEST(Decoders, DropASliceWithoutAPoint) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Codec(kExample);
  SetCaps(h.get(), OrganisedInfo(model, 64));
  const ElementPtr dec(gst_bin_get_by_name(GST_BIN(h->element), "dec"));
  auto& decode = GST_LIDAR_DECODER_GET_CLASS(dec.get())->decode;
  const auto real = std::exchange(
      decode, [](GstLidarDecoder*, const guint8*, gsize, guint, GstLidarDecodedSlice* slice) {
        slice->width = 0;
        return gboolean{TRUE};
      });
  EXPECT_EQ(gst_harness_push(h.get(), OrganisedBuffer(model, 64, {0, 0, 8, 0})), GST_FLOW_OK);
  decode = real;
  EXPECT_EQ(test::StatOf(dec.get(), "slices-dropped"), 1U);
  EXPECT_EQ(gst_harness_buffers_received(h.get()), 0U);
}

TEST(Decoders, TellTheAgeOfTheNewestSlice) {
  GError* error = nullptr;
  const ElementPtr pipeline(
      gst_parse_launch("lidartestsrc num-buffers=1 model=os1-32 mode=512x10 ! lidarenc ! lidardec "
                       "name=d ! fakesink name=s",
                       &error));
  ASSERT_EQ(error, nullptr);
  const ElementPtr decoder(gst_bin_get_by_name(GST_BIN(pipeline.get()), "d"));
  guint64 age = 0;
  g_object_get(decoder.get(), "age", &age, nullptr);
  EXPECT_EQ(age, GST_CLOCK_TIME_NONE);
  gst_element_set_state(pipeline.get(), GST_STATE_PAUSED);
  ASSERT_EQ(gst_element_get_state(pipeline.get(), nullptr, nullptr, test::kPatience_ns),
            GST_STATE_CHANGE_SUCCESS);
  const ElementPtr sink(gst_bin_get_by_name(GST_BIN(pipeline.get()), "s"));
  GstSample* sample = nullptr;
  g_object_get(sink.get(), "last-sample", &sample, nullptr);
  ASSERT_NE(sample, nullptr);
  const GstClockTime captured = gst_lidar_buffer_get_capture_time(gst_sample_get_buffer(sample));
  gst_sample_unref(sample);
  const auto now = [] { return static_cast<GstClockTime>(g_get_real_time()) * GST_USECOND; };
  const GstClockTime before = now();
  g_object_get(decoder.get(), "age", &age, nullptr);
  EXPECT_GE(age, before - captured);
  EXPECT_LE(age, now() - captured);
  const StructurePtr stats(StatsOf(decoder.get()));
  EXPECT_TRUE(gst_structure_has_field_typed(stats.get(), "age", G_TYPE_UINT64));
  gst_element_set_state(pipeline.get(), GST_STATE_NULL);
}

}  // namespace
}  // namespace lidar::gst
