// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of lidarodometry's pad for an IMU.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ext/odometry/imu_input.h"
#include "gst/common/imu_caps.h"
#include "gst/lidar/gstlidar.h"
#include "src/cdr/motion_samples.h"
#include "tests/support/element_bus.h"
#include "tests/support/element_stats.h"
#include "tests/support/harness.h"
#include "tests/support/patience.h"

namespace lidar::gst {
namespace {

using test::Harness;

constexpr unsigned kScans = 12;

/// A fixture with a sensor that does not move, in a corner of walls, and an IMU that measures no
/// motion.
class ImuPad : public ::testing::Test {
 protected:
  void SetUp() override {
    h_.reset(gst_harness_new("lidarodometry"));
    gst_harness_set_src_caps_str(h_.get(),
                                 "application/x-pointcloud2,width=0,height=1,point-step=12,"
                                 "fields=(string)\"x:F32:0,y:F32:4,z:F32:8\",framerate=10/1");
    imu_.reset(gst_element_request_pad_simple(h_->element, "imu"));
    ASSERT_TRUE(imu_);
  }
  void TearDown() override {
    if (imu_) gst_element_release_request_pad(h_->element, imu_.get());
    imu_.reset();
    h_.reset();
  }
  static GstBuffer* Corner(GstClockTime time) {
    std::vector<float> xyz;
    for (int a = -10; a < 10; ++a) {
      for (int b = -10; b < 10; ++b) {
        const auto u = static_cast<float>(a);
        const auto v = static_cast<float>(b);
        xyz.insert(xyz.end(), {u, v, -2, u, 10, v, 10, u, v});
      }
    }
    GstBuffer* buffer = gst_buffer_new_memdup(xyz.data(), xyz.size() * sizeof(float));
    GST_BUFFER_PTS(buffer) = time;
    return buffer;
  }
  bool Describe(const char* fields) {
    gst_pad_send_event(imu_.get(), gst_event_new_stream_start("imu"));
    const CapsPtr caps(gst_caps_new_simple(GST_LIDAR_IMU_MEDIA_TYPE, "sample-size", G_TYPE_INT, 32,
                                           "fields", G_TYPE_STRING, fields, nullptr));
    if (!gst_pad_send_event(imu_.get(), gst_event_new_caps(caps.get()))) return false;
    return gst_pad_send_event(imu_.get(), test::NewSegment());
  }
  /// Sends ten samples, which last one scan from `start` on. They measure a rotation at `rate`
  /// about the vertical axis.
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
    for (GstClockTime i = 0; i < kScans; ++i) {
      const GstClockTime start = i * 100 * GST_MSECOND;
      EXPECT_EQ(Send(start, rate), GST_FLOW_OK);
      EXPECT_EQ(gst_harness_push(h_.get(), Corner(start)), GST_FLOW_OK);
    }
    return test::StatOf(h_->element, "scans-with-imu");
  }

  Harness h_;
  PadPtr imu_;
};

TEST(ImuInput, TurnsRatesAsTheImuIsMounted) {
  ImuInput input;
  const ImuToSensor quarter = {0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  ASSERT_TRUE(input.SetCaps(ImuCaps(quarter).get()));
  cdr::Imu imu;
  imu.angular_velocity = {1, 0, 0.5};
  const auto sample = cdr::WriteImuSample(imu);
  ASSERT_TRUE(input.Add({sample.data(), sample.size()}));
  const auto turns = input.Take();
  ASSERT_EQ(turns.size(), 1U);
  EXPECT_LT((turns[0].rate - Eigen::Vector3d(0, 1, 0.5)).norm(), 1e-6) << turns[0].rate;
}

TEST(ImuInput, KeepsTheNewestSamplesWhereNoScanTakesThem) {
  constexpr std::size_t kTooMany = 10;
  ImuInput input;
  ASSERT_TRUE(input.SetCaps(ImuCaps({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}).get()));
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < ImuInput::kMostSamples + kTooMany; ++i) {
    cdr::Imu imu;
    imu.header.stamp = Time{} + Duration{static_cast<std::int64_t>(i)};
    const auto sample = cdr::WriteImuSample(imu);
    bytes.insert(bytes.end(), sample.begin(), sample.end());
  }
  ASSERT_TRUE(input.Add({bytes.data(), bytes.size()}));
  const auto kept = input.Take();
  ASSERT_EQ(kept.size(), ImuInput::kMostSamples);
  EXPECT_EQ(kept.front().time, Time{} + Duration{kTooMany});
  EXPECT_EQ(kept.back().time, Time{} + Duration{kTooMany + ImuInput::kMostSamples - 1});
  ASSERT_TRUE(input.Add({bytes.data(), kImuSampleSize}));
  input.Clear();
  EXPECT_TRUE(input.Take().empty());
}

TEST(ImuInput, TakesNothingOnceTheLayoutIsAnother) {
  ImuInput input;
  ASSERT_TRUE(input.SetCaps(ImuCaps({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}).get()));
  const CapsPtr other(gst_caps_new_simple(GST_LIDAR_IMU_MEDIA_TYPE, "fields", G_TYPE_STRING,
                                          "t:U64:0,gx:F64:8", nullptr));
  EXPECT_FALSE(input.SetCaps(other.get()));
  const auto sample = cdr::WriteImuSample({});
  EXPECT_FALSE(input.Add({sample.data(), sample.size()}));
  EXPECT_TRUE(input.Take().empty());
}

/// Returns the caps of ImuCaps() with another `imu-to-sensor`. Its `count` numbers are zeros,
/// except for `one` on the diagonal of the matrix.
template <class Number>
CapsPtr CapsWith(GType type, guint count, Number one, void (*set)(GValue*, Number)) {
  GValue list = G_VALUE_INIT;
  g_value_init(&list, GST_TYPE_ARRAY);
  for (guint i = 0; i < count; ++i) {
    GValue number = G_VALUE_INIT;
    g_value_init(&number, type);
    set(&number, i % 5 == 0 ? one : Number{0});
    gst_value_array_append_and_take_value(&list, &number);
  }
  CapsPtr caps(gst_caps_copy(ImuCaps({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}).get()));
  gst_structure_take_value(gst_caps_get_structure(caps.get(), 0), "imu-to-sensor", &list);
  return caps;
}

TEST(ImuInput, RefusesWhatIsNoRotation) {
  ImuInput input;
  EXPECT_TRUE(input.SetCaps(CapsWith<gdouble>(G_TYPE_DOUBLE, 16, 1, g_value_set_double).get()));
  EXPECT_FALSE(input.SetCaps(CapsWith<gdouble>(G_TYPE_DOUBLE, 15, 1, g_value_set_double).get()));
  EXPECT_FALSE(input.SetCaps(CapsWith<gdouble>(G_TYPE_DOUBLE, 16, 2, g_value_set_double).get()));
  EXPECT_FALSE(input.SetCaps(CapsWith<gint>(G_TYPE_INT, 16, 1, g_value_set_int).get()));
  const CapsPtr text(
      gst_caps_copy(ImuCaps({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}).get()));
  gst_caps_set_simple(text.get(), "imu-to-sensor", G_TYPE_STRING, "1", nullptr);
  EXPECT_FALSE(input.SetCaps(text.get()));
}

TEST_F(ImuPad, IsRequestedOnce) {
  GstPadTemplate* imu =
      gst_element_class_get_pad_template(GST_ELEMENT_GET_CLASS(h_->element), "imu");
  EXPECT_EQ(gst_element_request_pad(h_->element, imu, nullptr, nullptr), nullptr);
}

TEST_F(ImuPad, UsesSamplesThatAgreeWithTheScans) {
  ASSERT_TRUE(Describe(kImuFields));
  EXPECT_GE(ScansWithImu(0), kScans / 2);
}

TEST_F(ImuPad, DoesNotUseSamplesThatContradictTheScans) {
  ASSERT_TRUE(Describe(kImuFields));
  EXPECT_EQ(ScansWithImu(1.5), 0U);
}

TEST_F(ImuPad, RefusesOtherLayouts) { EXPECT_FALSE(Describe("t:U64:0,gx:F64:8")); }

TEST_F(ImuPad, DropsPiecesOfSamples) {
  ASSERT_TRUE(Describe(kImuFields));
  EXPECT_EQ(gst_pad_chain(imu_.get(), gst_buffer_new_memdup("cut", 3)), GST_FLOW_OK);
  EXPECT_GE(ScansWithImu(0), kScans / 2);
}

/// A fixture with a drive through the corners of a town, to test how the odometry uses its IMU.
class ImuOfADrive : public ::testing::Test {
 protected:
  static constexpr guint64 kDriveScans = 24;
  void SetUp() override {
    const std::string line =
        "lidartestsrc name=s imu=true model=os0-32 mode=512x10 scene=town speed=12 seed=3 "
        "roughness=3 "
        "slices-per-scan=1 num-buffers=" +
        std::to_string(kDriveScans) +
        " ! lidarodometry name=o ! fakesink async=false s.imu ! identity name=i ! o.imu";
    pipeline_.reset(gst_parse_launch(line.c_str(), nullptr));
    ASSERT_TRUE(pipeline_);
    odometry_.reset(gst_bin_get_by_name(GST_BIN(pipeline_.get()), "o"));
    const ElementPtr imu(gst_bin_get_by_name(GST_BIN(pipeline_.get()), "i"));
    imu_.reset(gst_element_get_static_pad(imu.get(), "src"));
    ASSERT_TRUE(imu_);
  }
  void TearDown() override { gst_element_set_state(pipeline_.get(), GST_STATE_NULL); }
  void Run() {
    gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING);
    const test::ElementBus bus(pipeline_.get());
    const MessagePtr end = bus.Wait(GST_MESSAGE_EOS | GST_MESSAGE_ERROR);
    ASSERT_TRUE(end);
    ASSERT_EQ(GST_MESSAGE_TYPE(end.get()), GST_MESSAGE_EOS);
  }
  guint64 Count(const char* name) { return test::StatOf(odometry_.get(), name); }

  ElementPtr pipeline_;
  ElementPtr odometry_;
  PadPtr imu_;
};

TEST_F(ImuOfADrive, IsUsedOnceItHasProvedItself) {
  Run();
  EXPECT_GE(Count("scans-with-imu"), kDriveScans - 10);
  EXPECT_EQ(Count("scans-lost"), 0U);
}

TEST_F(ImuOfADrive, MayStop) {
  gst_pad_add_probe(
      imu_.get(), GST_PAD_PROBE_TYPE_BUFFER,
      [](GstPad*, GstPadProbeInfo* info, gpointer) {
        return GST_BUFFER_PTS(GST_PAD_PROBE_INFO_BUFFER(info)) < 1500 * GST_MSECOND
                   ? GST_PAD_PROBE_OK
                   : GST_PAD_PROBE_DROP;
      },
      nullptr, nullptr);
  Run();
  EXPECT_GE(Count("scans-with-imu"), 5U);
  EXPECT_LE(Count("scans-with-imu"), 16U);
  EXPECT_EQ(Count("scans-lost"), 0U);
}

TEST_F(ImuOfADrive, IsNotUsedWhereItsAxesAreTurned) {
  gst_pad_add_probe(
      imu_.get(), GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM,
      [](GstPad*, GstPadProbeInfo* info, gpointer) {
        GstEvent* event = GST_PAD_PROBE_INFO_EVENT(info);
        if (GST_EVENT_TYPE(event) != GST_EVENT_CAPS) return GST_PAD_PROBE_OK;
        const ImuToSensor on_its_side = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
        gst_event_unref(event);
        GST_PAD_PROBE_INFO_DATA(info) = gst_event_new_caps(ImuCaps(on_its_side).get());
        return GST_PAD_PROBE_OK;
      },
      nullptr, nullptr);
  Run();
  EXPECT_LE(Count("scans-with-imu"), kDriveScans / 4);
  EXPECT_EQ(Count("scans-lost"), 0U);
}

}  // namespace
}  // namespace lidar::gst
