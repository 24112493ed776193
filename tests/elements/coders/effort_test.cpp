// SPDX-License-Identifier: LGPL-2.1-or-later
// The property effort of lidarenc.
#include <gtest/gtest.h>

#include "tests/elements/coders/coder_harness.h"

namespace lidar::gst {
namespace {

/// lidarenc and lidardec, fed with slices of a room.
class EffortHarness {
 public:
  EffortHarness(const std::string& properties, gint scans, gint seconds)
      : harness_(Codec(kLidar, properties)) {
    SetRate(scans, seconds);
  }
  /// Sends caps.
  void SetRate(gint scans, gint seconds) {
    CloudInfo info = OrganisedInfo(model_, 64);
    info.framerate_n = scans;
    info.framerate_d = seconds;
    SetCaps(harness_.get(), info);
  }
  /// Returns the mode of the slice that was pushed, after a check that it decodes within the error.
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

// A scan takes a minute here, so that any machine has time.
TEST(Effort, RisesByItselfWhereThereIsTime) {
  EXPECT_EQ(EffortHarness("effort=auto", 1, 60).Push(40), "range-mixing3");
}

// A slice sweeps in a microsecond here, so that no machine has time.
TEST(Effort, FallsByItselfWhereThereIsNone) {
  EXPECT_EQ(EffortHarness("effort=auto", 125'000, 1).Push(20), "range-adaptive");
}

TEST(Effort, StaysWhereOnlyTheCapsAreOthers) {
  EffortHarness h("effort=auto", 125'000, 1);
  EXPECT_EQ(h.Push(20), "range-adaptive");
  h.SetRate(125'001, 1);
  EXPECT_EQ(h.Push(), "range-adaptive");
}

}  // namespace
}  // namespace lidar::gst
