// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of the property effort of lidarenc.
#include <gtest/gtest.h>

#include "tests/elements/coders/plain_clouds.h"
#include "tests/elements/coders/stopped_clock.h"

namespace lidar::gst {
namespace {

/// A lidarenc and a lidardec, to which the test pushes slices of a room.
class EffortHarness {
 public:
  EffortHarness(const std::string& properties, gint scans, gint seconds)
      : harness_(Codec(kLidar, properties)) {
    SetRate(scans, seconds);
  }
  /// Sets caps whose frame rate is `scans` per `seconds`.
  void SetRate(gint scans, gint seconds) {
    CloudInfo info = OrganisedInfo(model_, 64);
    info.framerate_n = scans;
    info.framerate_d = seconds;
    SetCaps(harness_.get(), info);
  }
  /// Pushes a slice, and expects that the error of the decoded slice is within the bound. Returns
  /// the slice's mode.
  std::string Push() {
    GstBuffer* input =
        OrganisedBuffer(model_, 64, {slices_ / 8, slices_ % 8, 8, 64 * (slices_ % 8)});
    ++slices_;
    const auto before = PointsOf(input, 20);
    const BufferPtr output(gst_harness_push_and_pull(harness_.get(), input));
    EXPECT_LE(LargestDistance(before, PointsOf(output.get(), 20)), 0.02 + 1e-5);
    const StructurePtr stats(StatsOf(encoder().get()));
    return gst_structure_get_string(stats.get(), "mode");
  }
  std::string Push(guint slices) {
    std::string mode;
    for (guint i = 0; i < slices; ++i) mode = Push();
    return mode;
  }
  ElementPtr encoder() const {
    return ElementPtr(gst_bin_get_by_name(GST_BIN(harness_->element), "enc"));
  }

 private:
  SensorModel model_ = test::RoomSensor();
  Harness harness_;
  guint slices_ = 0;
};

TEST(Effort, ThatIsFixedIsWhatSlicesAreCodedWith) {
  EXPECT_EQ(EffortHarness("effort=0", 10, 1).Push(8), "range-adaptive");
  EXPECT_EQ(EffortHarness("effort=1", 10, 1).Push(8), "range-mixing1");
  EXPECT_EQ(EffortHarness("effort=2", 10, 1).Push(8), "range-mixing2");
  EXPECT_EQ(EffortHarness("effort=3", 10, 1).Push(8), "range-mixing3");
}

TEST(Effort, MayChangeFromSliceToSlice) {
  EffortHarness h("effort=0", 10, 1);
  EXPECT_EQ(h.Push(), "range-adaptive");
  gst_util_set_object_arg(G_OBJECT(h.encoder().get()), "effort", "2");
  EXPECT_EQ(h.Push(), "range-mixing2");
}

// A scan lasts a minute here, and the coder takes microseconds of the stopped clock.
TEST(Effort, RisesByItselfWhereThereIsTime) {
  const test::StoppedClock clock;
  EXPECT_EQ(EffortHarness("effort=auto", 1, 60).Push(40), "range-mixing3");
}

// The sensor needs a microsecond for a slice here, so no machine has enough time.
TEST(Effort, FallsByItselfWhereThereIsNone) {
  EXPECT_EQ(EffortHarness("effort=auto", 125'000, 1).Push(20), "range-adaptive");
}

// With the stopped clock, a scan lasts 16 us, and the coder takes 2 us per cloud. If a scan
// consists of one cloud, the coder uses an eighth of the time. If a scan consists of eight clouds,
// the coder uses all of the time.
TEST(Effort, FallsWherePointsHaveTheTimeOfASliceOnly) {
  const test::StoppedClock clock;
  for (const guint slices : {1U, 8U}) {
    const Harness h = Encoder(kLidarXyz, "effort=auto");
    CloudInfo info = XyzInfo(500);
    info.framerate_n = 62'500;
    SetCaps(h.get(), info);
    for (guint i = 0; i < 20; ++i) {
      const GstLidarSlice slice{i / slices, i % slices, slices, 0};
      GstBuffer* input = PlainBuffer(RandomPoints(500, 40));
      gst_lidar_buffer_set_slice(input, &slice);
      ASSERT_EQ(gst_harness_push(h.get(), input), GST_FLOW_OK);
    }
    const ElementPtr encoder(gst_bin_get_by_name(GST_BIN(h->element), "enc"));
    const StructurePtr stats(StatsOf(encoder.get()));
    EXPECT_STREQ(gst_structure_get_string(stats.get(), "mode"),
                 slices == 1 ? "xyz-cloud1" : "xyz-cloud0");
  }
}

TEST(Effort, StaysWhereOnlyTheCapsAreOthers) {
  EffortHarness h("effort=auto", 125'000, 1);
  EXPECT_EQ(h.Push(20), "range-adaptive");
  h.SetRate(125'001, 1);
  EXPECT_EQ(h.Push(), "range-adaptive");
}

/// Such clouds come from a driver that leaves out missing returns.
TEST(Effort, FallsWhereEachCloudHasAWidthOfItsOwn) {
  const Harness h = Encoder(kLidarXyz, "effort=auto");
  for (guint points = 500; points < 520; ++points) {
    CloudInfo info = XyzInfo(points);
    info.framerate_n = 1'000'000;
    SetCaps(h.get(), info);
    ASSERT_EQ(gst_harness_push(h.get(), PlainBuffer(RandomPoints(points, 50))), GST_FLOW_OK);
  }
  const ElementPtr encoder(gst_harness_find_element(h.get(), "lidarenc"));
  const StructurePtr stats(StatsOf(encoder.get()));
  EXPECT_STREQ(gst_structure_get_string(stats.get(), "mode"), "xyz-cloud0");
}

}  // namespace
}  // namespace lidar::gst
