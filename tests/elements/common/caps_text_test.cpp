// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/common/caps_text.h"

#include <gtest/gtest.h>

#include "gst/common/imu_caps.h"
#include "gst/lidar/gstlidar.h"

namespace lidar::gst {
namespace {

class CapsText : public ::testing::Test {
 protected:
  void SetUp() override { gst_lidar_init(); }
};

CapsPtr OfEachType() {
  const BufferPtr bytes(gst_buffer_new_memdup("abc", 3));
  const BufferPtr none(gst_buffer_new());
  return CapsPtr(gst_caps_new_simple(
      "application/x-a", "fields", G_TYPE_STRING, "x:F32:0,y:F32:4", "frame-id", G_TYPE_STRING,
      "r\xC3\xBC"
      "ck \"\\",
      "empty", G_TYPE_STRING, "", "word", G_TYPE_STRING, "NULL", "flag", G_TYPE_BOOLEAN, TRUE,
      "int", G_TYPE_INT, -5, "uint", G_TYPE_UINT, 7U, "long", G_TYPE_INT64, gint64{-9}, "ulong",
      G_TYPE_UINT64, guint64{9}, "float", G_TYPE_FLOAT, 0.5, "double", G_TYPE_DOUBLE, -0.25,
      "framerate", GST_TYPE_FRACTION, 10, 1, "sensor-model", GST_TYPE_BUFFER, bytes.get(), "none",
      GST_TYPE_BUFFER, none.get(), nullptr));
}

TEST_F(CapsText, OfAnArrayOfDoublesIsWhatGStreamerWritesAndComesBack) {
  const CapsPtr caps = ImuCaps({1, 0, 0, 0.25, 0, -1, 0, -0.5, 0, 0, 1, 3, 0, 0, 0, 1});
  const StringPtr text(gst_caps_to_string(caps.get()));
  EXPECT_EQ(CapsToText(caps.get()).value_or(""), text.get());
  const CapsPtr back = CapsFromText(text.get());
  ASSERT_TRUE(back);
  EXPECT_TRUE(gst_caps_is_equal(back.get(), caps.get()));
}

TEST_F(CapsText, IsWhatGStreamerWrites) {
  const CapsPtr caps = OfEachType();
  const StringPtr text(gst_caps_to_string(caps.get()));
  EXPECT_EQ(CapsToText(caps.get()).value_or(""), text.get());
}

TEST_F(CapsText, OfEachTypeComesBack) {
  const CapsPtr caps = OfEachType();
  const CapsPtr back = CapsFromText(CapsToText(caps.get()).value_or(""));
  ASSERT_TRUE(back);
  EXPECT_TRUE(gst_caps_is_fixed(back.get()));
  EXPECT_TRUE(gst_caps_is_equal(back.get(), caps.get()));
}

struct Refused {
  const char* caps;
  const char* why;
};
class OtherCaps : public ::testing::TestWithParam<Refused> {};
TEST_P(OtherCaps, AreRefusedWithTheReason) {
  gst_lidar_init();
  const CapsPtr caps(gst_caps_from_string(GetParam().caps));
  std::string why;
  EXPECT_FALSE(CapsToText(caps.get(), &why));
  EXPECT_EQ(why, GetParam().why);
}
constexpr const char* kNotOne = "the caps must describe one stream in system memory";
INSTANTIATE_TEST_SUITE_P(
    All, OtherCaps,
    ::testing::Values(
        Refused{"ANY", kNotOne}, Refused{"EMPTY", kNotOne},
        Refused{"application/x-a; application/x-b", kNotOne},
        Refused{"application/x-a(memory:GLMemory)", kNotOne},
        Refused{"video/x-raw", "video/x-raw does not begin with application/x-"},
        Refused{"application/x-a, n=(int)[ 1, 2 ]",
                "the field n is not a string, number, fraction, flag, buffer or array of doubles"},
        Refused{"application/x-a, n=(double)<  >", "the field n must have 1 to 16 values"},
        Refused{
            "application/x-a, n=(int)< 1, 2 >",
            "the field n is not a string, number, fraction, flag, buffer or array of doubles"}));

}  // namespace
}  // namespace lidar::gst
