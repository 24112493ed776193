// SPDX-License-Identifier: LGPL-2.1-or-later
// Scans of several sensors become one cloud.
#include <gtest/gtest.h>

#include <cstring>

#include "tests/elements/mcap/recording.h"

namespace lidar::test {
namespace {

class Merge : public Recording {};

/// Points of 20 bytes that are returns.
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
    ASSERT_EQ(merged[i].bytes.size(), 2 * 20 * returns);  // both see the same world
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
  // Three scans of the first sensor have no partner, and its last ones are alone again.
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
            "Clouds of sink_0 cannot be merged: transform wants 16 numbers, or x, y, z, roll, "
            "pitch, yaw.");
  EXPECT_EQ(Play("pointcloudmerge name=m ! fakesink " + scan + "m.sink_0 " + scan +
                 "pointcloudfilter fields=x,y,z ! m.sink_1")
                .error,
            "Clouds of sink_1 cannot be merged: there is no field intensity among "
            "x:F32:0,y:F32:4,z:F32:8.");
  EXPECT_NE(Play("pointcloudmerge name=m ! fakesink " + kSensor + " num-buffers=8 ! m.").warning,
            "");
}

}  // namespace
}  // namespace lidar::test
