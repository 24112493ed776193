// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include "tests/elements/coders/coder_harness.h"

namespace lidar::gst {
namespace {

/// Pushes `scans` scans of 8 slices. Returns the bytes of each scan, or 0 for a skipped scan.
/// Expects that no scan is skipped only in part.
std::vector<gsize> ScanSizes(GstHarness* h, const SensorModel& model, guint scans) {
  std::vector<gsize> sizes;
  for (guint scan = 0; scan < scans; ++scan) {
    gsize bytes = 0;
    guint slices = 0;
    for (guint i = 0; i < 8; ++i) {
      EXPECT_EQ(gst_harness_push(h, OrganisedBuffer(model, 64, {scan, i, 8, 64 * i})), GST_FLOW_OK);
      while (const BufferPtr out{gst_harness_try_pull(h)}) {
        bytes += gst_buffer_get_size(out.get());
        ++slices;
      }
    }
    EXPECT_TRUE(slices == 0 || slices == 8) << scan;
    sizes.push_back(bytes);
  }
  return sizes;
}

guint CountGaps(GstHarness* h) {
  guint gaps = 0;
  while (const EventPtr event{gst_harness_try_pull_event(h)})
    gaps += GST_EVENT_TYPE(event.get()) == GST_EVENT_GAP ? 1U : 0U;
  return gaps;
}

TEST_P(EitherCoder, KeepsToATargetBitrateThatComesFromDownstream) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Encoder(GetParam(), "max-error=0.2 intensity-bits=0 bitrate=1");
  SetCaps(h.get(), OrganisedInfo(model, 64));
  // This target is about 4 bits per return.
  const GstLidarTargetBitrate target{640'000, 0, 0, 0, 0, 0, "update"};
  gst_harness_push_upstream_event(h.get(), gst_lidar_event_new_target_bitrate(&target));
  const auto sizes = ScanSizes(h.get(), model, 30);
  double bits = 0;
  for (std::size_t i = 10; i < sizes.size(); ++i) bits += 8 * static_cast<double>(sizes[i]);
  EXPECT_NEAR(bits / 20 * 10, 640'000, 0.03 * 640'000);
  EXPECT_EQ(CountGaps(h.get()), 0U);
}

guint StatOf(GstHarness* h, const char* name) {
  const ElementPtr enc(gst_bin_get_by_name(GST_BIN(h->element), "enc"));
  return static_cast<guint>(test::StatOf(enc.get(), name));
}

void SetTarget(GstHarness* h, guint bps) {
  const GstLidarTargetBitrate target{bps, 0, 0, 0, 0, 0, "update"};
  gst_harness_push_upstream_event(h, gst_lidar_event_new_target_bitrate(&target));
}

TEST_P(EitherCoder, SendsNextToNothingWhereTheTargetBitrateIsZero) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Encoder(GetParam());
  SetCaps(h.get(), OrganisedInfo(model, 64));
  SetTarget(h.get(), 0);
  const auto sizes = ScanSizes(h.get(), model, 20);
  EXPECT_EQ(std::count(sizes.begin() + 2, sizes.end(), gsize{0}), 18);
}

TEST_P(EitherCoder, ForgetsTheTargetBitrateOfTheRunBefore) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Encoder(GetParam(), "bitrate=3000000");
  SetCaps(h.get(), OrganisedInfo(model, 64));
  SetTarget(h.get(), 640'000);
  ScanSizes(h.get(), model, 1);
  EXPECT_EQ(StatOf(h.get(), "target-bitrate"), 640'000U);
  ASSERT_EQ(gst_element_set_state(h->element, GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
  gst_harness_play(h.get());
  gst_harness_push_event(h.get(), gst_event_new_stream_start("again"));
  SetCaps(h.get(), OrganisedInfo(model, 64));
  ScanSizes(h.get(), model, 1);
  EXPECT_EQ(StatOf(h.get(), "target-bitrate"), 3'000'000U);
}

TEST_P(EitherCoder, KnowsNoMinimumBeforeTheFirstScanOfASecondRun) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Encoder(GetParam());
  const ElementPtr enc(gst_bin_get_by_name(GST_BIN(h->element), "enc"));
  const auto minimum = [&] {
    guint bps = 0;
    g_object_get(enc.get(), "min-bitrate", &bps, nullptr);
    return bps;
  };
  SetCaps(h.get(), OrganisedInfo(model, 64));
  ScanSizes(h.get(), model, 2);
  EXPECT_GT(minimum(), 0U);
  ASSERT_EQ(gst_element_set_state(h->element, GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
  gst_harness_play(h.get());
  EXPECT_EQ(minimum(), 0U);
}

TEST_P(EitherCoder, TellsItsBitrateFromTheFirstScanOn) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Encoder(GetParam());
  CloudInfo info = OrganisedInfo(model, 64);
  info.framerate_n = 15;
  info.framerate_d = 2;
  SetCaps(h.get(), info);
  const auto sizes = ScanSizes(h.get(), model, 2);
  // The first scan is counted when the second scan begins. The frame rate is 7.5 scans per second.
  EXPECT_NEAR(StatOf(h.get(), "bitrate"), 60.0 * static_cast<double>(sizes[0]),
              0.2 * 60 * static_cast<double>(sizes[0]));
}

TEST_P(EitherCoder, MarksTheFirstSliceBehindAFlush) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Encoder(GetParam());
  SetCaps(h.get(), OrganisedInfo(model, 64));
  const auto next = [&](guint i) {
    const BufferPtr slice(
        gst_harness_push_and_pull(h.get(), OrganisedBuffer(model, 64, {0, i, 8, 64 * i})));
    return GST_BUFFER_IS_DISCONT(slice.get());
  };
  next(0);
  EXPECT_FALSE(next(1));
  test::Flush(h.get());
  EXPECT_TRUE(next(2));
  EXPECT_FALSE(next(3));
}

TEST_P(EitherCoder, TellsDownstreamWhatItsErrorBoundNeeds) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Encoder(GetParam());
  const ElementPtr enc(gst_bin_get_by_name(GST_BIN(h->element), "enc"));
  int notified = 0;
  g_signal_connect(enc.get(), "notify::min-bitrate",
                   G_CALLBACK(+[](GObject*, GParamSpec*, int* n) { ++*n; }), &notified);
  SetCaps(h.get(), OrganisedInfo(model, 64));
  const auto sizes = ScanSizes(h.get(), model, 10);
  EXPECT_GT(notified, 0);
  GstLidarBitrateBounds bounds{};
  while (const EventPtr event{gst_harness_try_pull_event(h.get())})
    gst_lidar_event_parse_bitrate_bounds(event.get(), &bounds);
  // The nominal bitrate is the bitrate that the error bound needs, with all bits of the intensity.
  EXPECT_NEAR(bounds.nominal_bitrate, 80.0 * static_cast<double>(sizes[9]),
              0.1 * 80 * static_cast<double>(sizes[9]));
  EXPECT_LE(bounds.min_bitrate, bounds.nominal_bitrate);
  EXPECT_LT(bounds.nominal_bitrate, bounds.max_bitrate);
}

TEST_P(EitherCoder, SkipsWholeScansEvenlyBelowTheMinimum) {
  const SensorModel model = test::RoomSensor();
  const Harness free = Encoder(GetParam(), "intensity-bits=0");
  const Harness tight = Encoder(GetParam(), "intensity-bits=0");
  SetCaps(free.get(), OrganisedInfo(model, 64));
  SetCaps(tight.get(), OrganisedInfo(model, 64));
  const gsize needed = ScanSizes(free.get(), model, 2)[1];
  const GstLidarTargetBitrate target{static_cast<guint>(needed) * 40, 0, 0, 0, 0, 0, "update"};
  gst_harness_push_upstream_event(tight.get(), gst_lidar_event_new_target_bitrate(&target));
  const auto sizes = ScanSizes(tight.get(), model, 30);
  // The target is half of the bitrate that is needed. Therefore every second scan is sent, and two
  // scans in a row are never skipped.
  guint sent = 0;
  for (std::size_t i = 10; i < 30; ++i) {
    sent += sizes[i] > 0 ? 1U : 0U;
    EXPECT_TRUE(sizes[i] > 0 || sizes[i - 1] > 0) << i;
  }
  EXPECT_NEAR(sent, 10, 1);
  const auto skipped = static_cast<guint>(std::count(sizes.begin(), sizes.end(), gsize{0}));
  EXPECT_EQ(CountGaps(tight.get()), 8 * skipped);
}

TEST_P(EitherCoder, ThinsScansInsteadWhereTheFrameRateMattersMore) {
  const SensorModel model = test::RoomSensor();
  const Harness free = Encoder(GetParam(), "intensity-bits=0");
  const Harness tight =
      Encoder(GetParam(), "intensity-bits=0 degradation-preference=maintain-framerate");
  SetCaps(free.get(), OrganisedInfo(model, 64));
  SetCaps(tight.get(), OrganisedInfo(model, 64));
  const gsize needed = ScanSizes(free.get(), model, 2)[1];
  const GstLidarTargetBitrate target{static_cast<guint>(needed) * 40, 0, 0, 0, 0, 0, "update"};
  gst_harness_push_upstream_event(tight.get(), gst_lidar_event_new_target_bitrate(&target));
  const auto sizes = ScanSizes(tight.get(), model, 20);
  double late = 0;
  for (std::size_t i = 10; i < sizes.size(); ++i) {
    EXPECT_GT(sizes[i], 0U) << i;
    late += static_cast<double>(sizes[i]) / 10;
  }
  EXPECT_NEAR(late, static_cast<double>(needed) / 2, 0.1 * static_cast<double>(needed));
  // The number of returns does not include those of beams that the encoder left out.
  const ElementPtr enc(gst_bin_get_by_name(GST_BIN(tight->element), "enc"));
  EXPECT_LT(test::StatOf(enc.get(), "returns"), 20 * 32 * 512 * 3 / 4);
}

}  // namespace
}  // namespace lidar::gst
