// SPDX-License-Identifier: LGPL-2.1-or-later
// lidarodometry's pad for an IMU.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "ext/odometry/imu_input.h"
#include "gst/lidar/gstlidar.h"
#include "src/cdr/motion_samples.h"
#include "tests/support/harness.h"

namespace lidar::gst {
namespace {

using test::Harness;

constexpr unsigned kScans = 12;

/// A sensor that stands, and beside it an IMU that says so.
class ImuPad : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string line =
        "lidartestsrc model=os0-32 mode=512x10 speed=0 slices-per-scan=1 num-buffers=" +
        std::to_string(kScans);
    source_.reset(gst_harness_new_parse(line.c_str()));
    gst_harness_play(source_.get());
    for (unsigned i = 0; i < kScans; ++i) scans_.emplace_back(gst_harness_pull(source_.get()));
    h_.reset(gst_harness_new("lidarodometry"));
    gst_harness_set_src_caps(h_.get(), gst_pad_get_current_caps(source_->sinkpad));
    imu_.reset(gst_element_request_pad_simple(h_->element, "imu"));
    ASSERT_TRUE(imu_);
  }
  void TearDown() override {
    if (imu_) gst_element_release_request_pad(h_->element, imu_.get());
    imu_.reset();
    scans_.clear();
    h_.reset();
    source_.reset();
  }
  bool Describe(const char* fields) {
    gst_pad_send_event(imu_.get(), gst_event_new_stream_start("imu"));
    const CapsPtr caps(gst_caps_new_simple(GST_LIDAR_IMU_MEDIA_TYPE, "sample-size", G_TYPE_INT, 32,
                                           "fields", G_TYPE_STRING, fields, nullptr));
    if (!gst_pad_send_event(imu_.get(), gst_event_new_caps(caps.get()))) return false;
    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_TIME);
    return gst_pad_send_event(imu_.get(), gst_event_new_segment(&segment));
  }
  /// Ten samples of a turn of `rate` about the vertical, over a scan that begins at `start`.
  GstFlowReturn Send(GstClockTime start, double rate) {
    std::vector<std::uint8_t> bytes;
    for (unsigned i = 0; i < 10; ++i) {
      cdr::Imu imu;
      imu.header.stamp = Time{} + Duration{static_cast<std::int64_t>(start + i * 10 * GST_MSECOND)};
      imu.angular_velocity = {0, 0, rate};
      const auto sample = cdr::WriteImuSample(imu);
      bytes.insert(bytes.end(), sample.begin(), sample.end());
    }
    return gst_pad_chain(imu_.get(), gst_buffer_new_memdup(bytes.data(), bytes.size()));
  }
  guint64 ScansWithImu(double rate) {
    for (BufferPtr& scan : scans_) {
      EXPECT_EQ(Send(gst_lidar_buffer_get_capture_time(scan.get()), rate), GST_FLOW_OK);
      EXPECT_EQ(gst_harness_push(h_.get(), scan.release()), GST_FLOW_OK);
    }
    GstStructure* stats = nullptr;
    g_object_get(h_->element, "stats", &stats, nullptr);
    guint64 count = 0;
    gst_structure_get_uint64(stats, "scans-with-imu", &count);
    gst_structure_free(stats);
    return count;
  }

  Harness source_;
  Harness h_;
  PadPtr imu_;
  std::vector<BufferPtr> scans_;
};

/// A quarter of a turn about the vertical, as row-major transforms have it.
CapsPtr TurnedCaps() {
  CapsPtr caps(gst_caps_new_simple(GST_LIDAR_IMU_MEDIA_TYPE, "sample-size", G_TYPE_INT, 32,
                                   "fields", G_TYPE_STRING, cdr::kImuFields, nullptr));
  GValue list = G_VALUE_INIT;
  g_value_init(&list, GST_TYPE_ARRAY);
  for (const double v : {0., -1., 0., 0., 1., 0., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.}) {
    GValue number = G_VALUE_INIT;
    g_value_init(&number, G_TYPE_DOUBLE);
    g_value_set_double(&number, v);
    gst_value_array_append_and_take_value(&list, &number);
  }
  gst_structure_take_value(gst_caps_get_structure(caps.get(), 0), "imu-to-sensor", &list);
  return caps;
}

TEST(ImuInput, TurnsRatesAsTheImuIsMounted) {
  ImuInput input;
  ASSERT_TRUE(input.SetCaps(TurnedCaps().get()));
  cdr::Imu imu;
  imu.angular_velocity = {1, 0, 0.5};
  const auto sample = cdr::WriteImuSample(imu);
  ASSERT_TRUE(input.Add({sample.data(), sample.size()}));
  const auto turns = input.Take();
  ASSERT_EQ(turns.size(), 1U);
  EXPECT_LT((turns[0].rate - Eigen::Vector3d(0, 1, 0.5)).norm(), 1e-6) << turns[0].rate;
}

TEST_F(ImuPad, UsesSamplesThatAgreeWithTheScans) {
  ASSERT_TRUE(Describe(cdr::kImuFields));
  EXPECT_GE(ScansWithImu(0), kScans / 2);
}

TEST_F(ImuPad, DoesNotUseSamplesThatContradictTheScans) {
  ASSERT_TRUE(Describe(cdr::kImuFields));
  EXPECT_EQ(ScansWithImu(1.5), 0U);
}

TEST_F(ImuPad, RefusesOtherLayouts) { EXPECT_FALSE(Describe("t:U64:0,gx:F64:8")); }

TEST_F(ImuPad, DropsPiecesOfSamples) {
  ASSERT_TRUE(Describe(cdr::kImuFields));
  EXPECT_EQ(gst_pad_chain(imu_.get(), gst_buffer_new_memdup("cut", 3)), GST_FLOW_OK);
  EXPECT_GE(ScansWithImu(0), kScans / 2);
}

}  // namespace
}  // namespace lidar::gst
