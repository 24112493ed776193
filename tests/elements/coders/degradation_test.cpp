// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests that the receiver counts the same losses as the sender when coders leave data out below
// min-bitrate.
#include <gtest/gtest.h>

#include <tuple>

#include "tests/elements/coders/coder_harness.h"

namespace lidar::gst {
namespace {

constexpr guint kScans = 20;

struct PreferenceCase {
  const char* name;
  bool skips;
  bool thins;
};
void PrintTo(const PreferenceCase& c, std::ostream* out) { *out << c.name; }

TEST_P(AnyCoder, TakesACloudWithoutItsPlaceForAScan) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Encoder(GetParam());
  SetCaps(h.get(), OrganisedInfo(model, 64));
  for (int i = 0; i < 3; ++i) {
    const BufferPtr placed(OrganisedBuffer(model, 64, {0, 0, 1, 0}));
    GstBuffer* buffer = gst_buffer_copy_region(placed.get(), GST_BUFFER_COPY_MEMORY, 0,
                                               gst_buffer_get_size(placed.get()));
    GstLidarSlice slice;
    ASSERT_FALSE(gst_lidar_buffer_get_slice(buffer, &slice));
    gst_buffer_unref(gst_harness_push_and_pull(h.get(), buffer));
  }
  const ElementPtr enc(gst_bin_get_by_name(GST_BIN(h->element), "enc"));
  EXPECT_EQ(test::StatOf(enc.get(), "scans-in"), 3U);
}

TEST(LidarEnc, NumbersScansWithoutAPlaceAlsoWhereItLeavesSomeOut) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Encoder(kLidar, "bitrate=16000");
  SetCaps(h.get(), OrganisedInfo(model, 64));
  guint scans = 0;
  for (guint i = 0; i < 30; ++i) {
    const BufferPtr placed(OrganisedBuffer(model, 64, {0, 0, 1, 0}));
    GstBuffer* buffer = gst_buffer_copy_region(placed.get(), GST_BUFFER_COPY_MEMORY, 0,
                                               gst_buffer_get_size(placed.get()));
    GST_BUFFER_PTS(buffer) = i * 100 * GST_MSECOND;
    ASSERT_EQ(gst_harness_push(h.get(), buffer), GST_FLOW_OK);
    while (BufferPtr coded{gst_harness_try_pull(h.get())}) {
      GstLidarSlice slice{};
      ASSERT_TRUE(gst_lidar_buffer_get_slice(coded.get(), &slice));
      EXPECT_EQ(slice.scan_id, GST_BUFFER_PTS(coded.get()) / (100 * GST_MSECOND));
      EXPECT_EQ(slice.slice_count, 1U);
      ++scans;
    }
  }
  EXPECT_GT(scans, 2U);
  EXPECT_LT(scans, 30U);
}

class BelowTheMinimum : public ::testing::TestWithParam<std::tuple<CoderCase, PreferenceCase>> {
 protected:
  static Harness Pipeline(const std::string& properties) {
    const CoderCase& coder = std::get<0>(GetParam());
    Harness h(gst_harness_new_parse((std::string(coder.encoder) + " name=enc intensity-bits=0 " +
                                     properties + " ! rtplidarpay ! rtplidardepay name=depay ! " +
                                     coder.decoder + " name=dec")
                                        .c_str()));
    SetCaps(h.get(), OrganisedInfo(Sensor(), 64));
    return h;
  }
  static const SensorModel& Sensor() {
    static const SensorModel model = test::RoomSensor();
    return model;
  }
  /// Pushes `scans` scans, beginning with scan `first`. Returns the number of decoded slices.
  static guint Play(GstHarness* h, guint first, guint scans) {
    guint slices = 0;
    for (guint i = 8 * first; i < 8 * (first + scans); ++i) {
      EXPECT_EQ(gst_harness_push(h, OrganisedBuffer(Sensor(), 64, {i / 8, i % 8, 8, 64 * (i % 8)})),
                GST_FLOW_OK);
      while (const BufferPtr out{gst_harness_try_pull(h)}) ++slices;
    }
    return slices;
  }
  static ElementPtr Find(GstHarness* h, const char* name) {
    return ElementPtr(gst_bin_get_by_name(GST_BIN(h->element), name));
  }
  static void SetTarget(GstHarness* h, guint bps) {
    const GstLidarTargetBitrate target{bps, 0, 0, 0, 0, 0, "update"};
    gst_harness_push_upstream_event(h, gst_lidar_event_new_target_bitrate(&target));
  }
  static guint Needed() {
    const Harness h = Pipeline("");
    Play(h.get(), 0, 3);
    guint bps = 0;
    g_object_get(Find(h.get(), "enc").get(), "min-bitrate", &bps, nullptr);
    return bps;
  }
};

TEST_P(BelowTheMinimum, TheReceiverKnowsWhatWasLeftOut) {
  const PreferenceCase& preference = std::get<1>(GetParam());
  const Harness h = Pipeline("degradation-preference=" + std::string(preference.name));
  const guint needed = Needed();
  SetTarget(h.get(), needed / 2);
  Play(h.get(), 0, kScans);
  const ElementPtr enc = Find(h.get(), "enc");
  const ElementPtr depay = Find(h.get(), "depay");
  const ElementPtr dec = Find(h.get(), "dec");
  const guint64 skipped = test::StatOf(enc.get(), "scans-skipped");
  EXPECT_EQ(skipped > kScans / 10, preference.skips);
  // If scans are skipped at the end, the receiver cannot count them, because no later scan arrives.
  EXPECT_NEAR(static_cast<double>(test::StatOf(depay.get(), "scans-skipped")),
              static_cast<double>(skipped), preference.skips ? 3 : 0);
  EXPECT_EQ(test::StatOf(depay.get(), "slices-lost"), 0U);
  EXPECT_EQ(test::StatOf(dec.get(), "slices"), 8 * (kScans - skipped));
  EXPECT_EQ(test::StatOf(dec.get(), "slices-thinned") > test::StatOf(dec.get(), "slices") / 2,
            preference.thins);
  // As soon as the target is above the minimum again, all slices are complete.
  SetTarget(h.get(), 2 * needed);
  const guint64 thinned = test::StatOf(dec.get(), "slices-thinned");
  EXPECT_EQ(Play(h.get(), kScans, 5), 40U);
  EXPECT_EQ(test::StatOf(dec.get(), "slices-thinned"), thinned);
}
INSTANTIATE_TEST_SUITE_P(
    All, BelowTheMinimum,
    ::testing::Combine(::testing::ValuesIn(RangeCoders()),
                       ::testing::Values(PreferenceCase{"maintain-accuracy", true, false},
                                         PreferenceCase{"maintain-framerate", false, true},
                                         PreferenceCase{"balanced", true, true})));

}  // namespace
}  // namespace lidar::gst
