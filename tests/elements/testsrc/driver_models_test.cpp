// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests of the models whose clouds are like those of the makers' ROS drivers.
#include <gst/base/gstpushsrc.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <set>

#include "gst/common/buffer_map.h"
#include "gst/lidar/cloud_info.h"
#include "src/synth/firing.h"
#include "src/synth/scanner.h"
#include "tests/support/harness.h"

namespace lidar::gst {
namespace {

using synth::Firing;
using test::Harness;
using test::SetPlaying;

class DriverModel : public ::testing::TestWithParam<const char*> {
 protected:
  DriverModel()
      : firing_(*synth::FindFiring(GetParam())),
        h_(gst_harness_new_parse(
            (std::string("lidartestsrc num-buffers=2 scene=tunnel model=") + GetParam()).c_str())) {
    // Stores the caps of each cloud, because each cloud has its own width, and the source may be
    // ahead of the test.
    gst_pad_add_probe(
        h_->sinkpad, GST_PAD_PROBE_TYPE_BUFFER,
        [](GstPad* pad, GstPadProbeInfo*, gpointer self) {
          g_async_queue_push(static_cast<DriverModel*>(self)->caps_, gst_pad_get_current_caps(pad));
          return GST_PAD_PROBE_OK;
        },
        this, nullptr);
    SetPlaying(h_.get());
  }
  ~DriverModel() override {
    h_.reset();
    g_async_queue_unref(caps_);
  }
  void Pull() {
    cloud_.reset(gst_harness_pull(h_.get()));
    const CapsPtr caps(static_cast<GstCaps*>(g_async_queue_pop(caps_)));
    info_ = *CloudInfo::FromFrameCaps(caps.get());
    const BufferMap map(cloud_.get(), GST_MAP_READ);
    bytes_.assign(map.data(), map.data() + map.size());
  }
  template <class T>
  T At(std::size_t point, const char* field) const {
    T value;
    std::memcpy(&value, bytes_.data() + point * info_.point_step + info_.fields.Find(field)->offset,
                sizeof value);
    return value;
  }
  std::uint32_t RingAt(std::size_t point) const {
    return info_.fields.Find("ring") != nullptr ? At<std::uint16_t>(point, "ring")
                                                : At<std::uint8_t>(point, "line");
  }
  /// Computes the inverse of Firing::RingOf().
  std::uint32_t LaserAt(std::size_t point) const {
    const std::uint32_t rings_of_a_bank = firing_.lasers / firing_.banks;
    const std::uint32_t ring = RingAt(point);
    return ring % rings_of_a_bank * firing_.banks + ring / rings_of_a_bank;
  }
  /// Returns the time of the point after the first column of the scan [s].
  double TimeAt(std::size_t point) const {
    if (info_.fields.Find("time") != nullptr) return static_cast<double>(At<float>(point, "time"));
    const auto begin =
        static_cast<double>(gst_lidar_buffer_get_capture_time(cloud_.get())) / GST_SECOND;
    return At<double>(point, "timestamp") * firing_.layout.timestamp_unit_s - begin;
  }
  struct Polar {
    double range_m, azimuth_deg, elevation_deg;
  };
  Polar PolarAt(std::size_t point) const {
    const auto x = static_cast<double>(At<float>(point, "x"));
    const auto y = static_cast<double>(At<float>(point, "y"));
    const auto z = static_cast<double>(At<float>(point, "z"));
    constexpr double kDegrees = 180 / 3.14159265358979;
    return {std::sqrt(x * x + y * y + z * z), std::atan2(-y, x) * kDegrees,
            std::atan2(z, std::hypot(x, y)) * kDegrees};
  }

  const Firing& firing_;
  Harness h_;
  // The caps of the clouds, in the order of the clouds.
  GAsyncQueue* const caps_ =
      g_async_queue_new_full([](gpointer caps) { gst_caps_unref(static_cast<GstCaps*>(caps)); });
  BufferPtr cloud_;
  CloudInfo info_;
  std::vector<guint8> bytes_;
};

TEST_P(DriverModel, PublishesOneRowOfReturnsInTheDriversLayout) {
  for (guint scan = 0; scan < 2; ++scan) {
    Pull();
    EXPECT_EQ(info_.fields.ToString(), firing_.layout.fields);
    EXPECT_EQ(info_.height, 1U);
    EXPECT_FALSE(info_.sensor_model);
    EXPECT_EQ(bytes_.size(), info_.FrameSize());
    EXPECT_LE(info_.width, firing_.lasers * firing_.columns);
    EXPECT_GT(info_.width, firing_.lasers * firing_.columns / 2);
    EXPECT_EQ(GST_BUFFER_PTS(cloud_.get()), scan * 100 * GST_MSECOND);
    GstLidarSlice slice{};
    ASSERT_TRUE(gst_lidar_buffer_get_slice(cloud_.get(), &slice));
    EXPECT_EQ(slice.slice_count, 1U);
  }
}

TEST_P(DriverModel, FiresEveryLaserInTurnOverTheWholeScan) {
  Pull();
  std::set<std::uint32_t> rings;
  // A number of seconds since 1970 in an F64 has a resolution of a quarter of a microsecond.
  const double slack = 5e-7;
  const double column_s = 0.1 / firing_.columns;
  for (std::size_t i = 0; i < info_.width; ++i) {
    rings.insert(RingAt(i));
    ASSERT_LT(RingAt(i), firing_.lasers);
    // After the start of its column.
    const double fires_s = 1e-9 * firing_.laser_delay_ns * LaserAt(i);
    const double columns = (TimeAt(i) - fires_s) / column_s;
    ASSERT_NEAR(columns, std::round(columns), 0.1) << i;
    if (i == 0) continue;
    ASSERT_GE(TimeAt(i), TimeAt(i - 1) - slack) << i;
  }
  EXPECT_EQ(rings.size(), firing_.lasers);
  EXPECT_NEAR(TimeAt(0), 0, 0.002);
  EXPECT_NEAR(TimeAt(info_.width - 1), 0.1, 0.002);
}

TEST_P(DriverModel, PointsLieWhereTheTableSays) {
  Pull();
  const std::uint32_t others = firing_.lasers - 1;
  std::size_t fans = 0;
  for (std::size_t i = 0; i < info_.width; i += 7) {
    const Polar p = PolarAt(i);
    const double ring_elevation = firing_.first_elevation + firing_.elevation_step * RingAt(i);
    const double fan = firing_.fan * others;
    ASSERT_NEAR(p.elevation_deg, ring_elevation, firing_.swing + fan / 2 + 1e-3) << i;
    const std::size_t last = i + others;
    if (fan > 0 && last < info_.width && RingAt(i) == 0 && RingAt(last) == others &&
        TimeAt(last) - TimeAt(i) < 2e-5) {
      const double rise = PolarAt(last).elevation_deg - p.elevation_deg;
      ASSERT_NEAR(rise, fan * std::sin(p.azimuth_deg * M_PI / 180), 0.5) << i;
      ++fans;
    }
    const double units = p.range_m * 1000 / firing_.range_unit_mm;
    ASSERT_NEAR(units, std::round(units), 0.02) << i;
    if (firing_.azimuth_unit > 0) {
      const double steps = p.azimuth_deg / firing_.azimuth_unit;
      ASSERT_NEAR(steps, std::round(steps), 0.01) << i;
    }
  }
  EXPECT_EQ(fans > 100, firing_.fan > 0);
}

TEST_P(DriverModel, RangesAreRoundedToTheNearestUnit) {
  Pull();
  synth::ScannerConfig config;  // has the defaults of the source
  config.sensor = synth::MakeSensor(firing_);
  config.scene = synth::SceneKind::kTunnel;
  config.speed_mps = 12;
  synth::Returns returns;
  synth::Scanner(config).Cast(0, {0, firing_.columns}, &returns);
  std::size_t point = 0;
  for (std::size_t column = 0; column < firing_.columns; ++column) {
    for (std::size_t laser = 0; laser < firing_.lasers; ++laser) {
      const std::uint32_t exact = returns.range_mm[laser * firing_.columns + column];
      if (exact == 0) continue;
      ASSERT_LT(point, info_.width);
      ASSERT_NEAR(PolarAt(point++).range_m * 1000, exact, firing_.range_unit_mm / 2.0 + 0.1);
    }
  }
  EXPECT_EQ(point, info_.width);
}

INSTANTIATE_TEST_SUITE_P(All, DriverModel, ::testing::Values("vlp-16", "xt32", "at128", "mid-360"));

TEST(DriverModels, ScansOfAMid360DoNotRepeat) {
  // The sensor does not move and has no noise. Therefore points of two scans would be equal if the
  // pattern of the beams repeated.
  Harness h(gst_harness_new_parse("lidartestsrc model=mid-360 speed=0 noise=0 num-buffers=2"));
  SetPlaying(h.get());
  std::set<std::array<float, 3>> first;
  for (int scan = 0; scan < 2; ++scan) {
    const BufferPtr cloud(gst_harness_pull(h.get()));
    const BufferMap map(cloud.get(), GST_MAP_READ);
    std::size_t again = 0;
    for (std::size_t at = 0; at < map.size(); at += 26) {
      std::array<float, 3> p;
      std::memcpy(p.data(), map.data() + at, sizeof p);
      if (scan == 0)
        first.insert(p);
      else
        again += first.count(p);
    }
    EXPECT_LT(again, 10U);
  }
}

TEST(DriverModels, SlicesCoverTheScanOnce) {
  guint points[2] = {0, 0};
  for (const guint slices : {1U, 8U}) {
    Harness h(gst_harness_new_parse(
        ("lidartestsrc model=xt32 slices-per-scan=" + std::to_string(slices)).c_str()));
    SetPlaying(h.get());
    for (guint i = 0; i < slices; ++i) {
      const BufferPtr slice(gst_harness_pull(h.get()));
      points[slices > 1] += static_cast<guint>(gst_buffer_get_size(slice.get()) / 26);
    }
  }
  EXPECT_EQ(points[0], points[1]);
}

/// A stop may come after a cloud was made and before its caps are sent. In this case the base class
/// would not free a buffer.
TEST(DriverModels, AStopBeforeTheCapsOfACloudLeavesNoBuffer) {
  const ElementPtr source(gst_element_factory_make("lidartestsrc", nullptr));
  gst_util_set_object_arg(G_OBJECT(source.get()), "model", "vlp-16");
  auto* base = GST_BASE_SRC(source.get());
  ASSERT_TRUE(GST_BASE_SRC_GET_CLASS(base)->start(base));
  ASSERT_TRUE(GST_PAD_IS_FLUSHING(GST_BASE_SRC_PAD(base)));
  GstBuffer* out = nullptr;
  EXPECT_EQ(GST_PUSH_SRC_GET_CLASS(base)->create(GST_PUSH_SRC(base), &out), GST_FLOW_FLUSHING);
  EXPECT_EQ(out, nullptr);
  EXPECT_TRUE(GST_BASE_SRC_GET_CLASS(base)->stop(base));
}

}  // namespace
}  // namespace lidar::gst
