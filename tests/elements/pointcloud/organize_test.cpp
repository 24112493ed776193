// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "gst/common/buffer_map.h"
#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidar.h"
#include "src/cloud/range_projection.h"
#include "tests/support/harness.h"

namespace lidar::gst {
namespace {

using test::Harness;

constexpr guint kRings = 16;
constexpr guint kColumnsOfTurn = 256;

SensorModel Model() {
  SensorModel model;
  model.columns_per_scan = kColumnsOfTurn;
  model.beam_to_lidar_x_m = 0.0158;
  for (guint k = 0; k < kRings; ++k) model.beams.push_back({k % 4 * 1.4, 15. - 2 * k, 0});
  return model;
}

/// x, y, z and a ring, as drivers give them.
CloudInfo DriverInfo() {
  CloudInfo info;
  info.width = kColumnsOfTurn;
  info.height = kRings;
  info.point_step = 14;
  info.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,ring:U16:12");
  return info;
}

std::vector<std::uint32_t> Ranges(unsigned seed = 1) {
  std::vector<std::uint32_t> ranges(kColumnsOfTurn * kRings);
  for (std::uint32_t i = 0; i < ranges.size(); ++i)
    ranges[i] = 1000 + (i * 7919 + seed * 104'729) % 40'000;
  return ranges;
}

std::vector<std::uint8_t> DriverCloud(const std::vector<std::uint32_t>& ranges) {
  std::vector<std::uint8_t> points(DriverInfo().FrameSize());
  RangeProjection(Model()).Project(ranges.data(), {0, kColumnsOfTurn}, points.data(), 14);
  for (std::size_t i = 0; i < ranges.size(); ++i)
    points[14 * i + 12] = static_cast<std::uint8_t>(i / kColumnsOfTurn);
  return points;
}

std::vector<std::string> EventsOf(GstHarness* h) {
  std::vector<std::string> names;
  while (const EventPtr event{gst_harness_try_pull_event(h)})
    names.emplace_back(GST_EVENT_TYPE_NAME(event.get()));
  return names;
}

class Organize : public ::testing::Test {
 protected:
  void Start(const CloudInfo& info, const char* behind = "") {
    h_.reset(gst_harness_new_parse((std::string("pointcloudorganize name=o") + behind).c_str()));
    bus_.reset(gst_bus_new());
    gst_element_set_bus(h_->element, bus_.get());
    gst_harness_set_src_caps(h_.get(), info.ToCaps());
  }
  GstFlowReturn Push(const std::vector<std::uint8_t>& points) {
    GstBuffer* buffer = gst_buffer_new_memdup(points.data(), points.size());
    GST_BUFFER_PTS(buffer) = ++pushed_ * GST_SECOND;
    gst_lidar_buffer_set_capture_time(buffer, 77 * GST_SECOND);
    return gst_harness_push(h_.get(), buffer);
  }
  BufferPtr Pull() { return BufferPtr(gst_harness_try_pull(h_.get())); }
  CloudInfo Output() {
    const CapsPtr caps(gst_pad_get_current_caps(h_->sinkpad));
    return CloudInfo::FromCaps(caps.get()).value_or(CloudInfo());
  }
  bool Warned() {
    return MessagePtr(gst_bus_pop_filtered(bus_.get(), GST_MESSAGE_WARNING)) != nullptr;
  }

  std::unique_ptr<GstBus, Unref> bus_;
  Harness h_;
  guint64 pushed_ = 0;
};

TEST_F(Organize, GivesCloudsOfAnyDriverRangesAndTheSensorModel) {
  Start(DriverInfo());
  const auto ranges = Ranges();
  ASSERT_EQ(Push(DriverCloud(ranges)), GST_FLOW_OK);
  const BufferPtr buffer = Pull();
  ASSERT_TRUE(buffer);
  const CloudInfo info = Output();
  EXPECT_EQ(info.fields.ToString(), "x:F32:0,y:F32:4,z:F32:8,ring:U16:12,range:U32:14");
  EXPECT_EQ(info.point_step, 18u);
  ASSERT_TRUE(info.sensor_model);
  EXPECT_EQ(info.sensor_model->beams.size(), kRings);
  EXPECT_EQ(GST_BUFFER_PTS(buffer.get()), GST_SECOND);
  EXPECT_EQ(gst_lidar_buffer_get_capture_time(buffer.get()), 77 * GST_SECOND);
  const BufferMap map(buffer.get(), GST_MAP_READ);
  ASSERT_EQ(map.size(), info.FrameSize());
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    std::uint32_t range = 0;
    std::memcpy(&range, map.data() + 18 * i + 14, sizeof range);
    ASSERT_NEAR(range, ranges[i], 1) << i;
    ASSERT_EQ(map.data()[18 * i + 12], i / kColumnsOfTurn);
  }
}

TEST_F(Organize, MakesMissingReturnsOfPointsThatStandElsewhere) {
  Start(DriverInfo());
  ASSERT_EQ(Push(DriverCloud(Ranges())), GST_FLOW_OK);
  Pull();
  auto points = DriverCloud(Ranges(2));
  const float elsewhere[3] = {1, 2, 3};
  std::memcpy(points.data() + 14 * 500, elsewhere, sizeof elsewhere);
  ASSERT_EQ(Push(points), GST_FLOW_OK);
  const BufferPtr buffer = Pull();
  ASSERT_TRUE(buffer);
  const BufferMap map(buffer.get(), GST_MAP_READ);
  const std::vector<std::uint8_t> zeros(12, 0);
  EXPECT_EQ(std::memcmp(map.data() + 18 * 500, zeros.data(), 12), 0);
  EXPECT_EQ(std::memcmp(map.data() + 18 * 500 + 14, zeros.data(), 4), 0);
  EXPECT_NE(std::memcmp(map.data() + 18 * 501, zeros.data(), 12), 0);
}

TEST_F(Organize, PointsMayStandOffTheirBeamsByMaxError) {
  Start(DriverInfo());
  const ElementPtr organize(gst_bin_get_by_name(GST_BIN(h_->element), "o"));
  g_object_set(organize.get(), "max-error", 0.1, nullptr);
  ASSERT_EQ(Push(DriverCloud(Ranges())), GST_FLOW_OK);
  Pull();
  for (const float off : {0.08F, 0.13F, 0.25F}) {
    auto points = DriverCloud(Ranges(2));
    std::uint8_t* point = points.data() + 14 * 500;
    float xyz[3];
    std::memcpy(xyz, point, sizeof xyz);
    const float away = std::hypot(xyz[0], xyz[1]);
    const float moved[3] = {xyz[0] - xyz[1] / away * off, xyz[1] + xyz[0] / away * off, xyz[2]};
    std::memcpy(point, moved, sizeof moved);
    ASSERT_EQ(Push(points), GST_FLOW_OK);
    const BufferPtr buffer = Pull();
    ASSERT_TRUE(buffer);
    const BufferMap map(buffer.get(), GST_MAP_READ);
    std::uint32_t range = 0;
    std::memcpy(&range, map.data() + 18 * 500 + 14, sizeof range);
    EXPECT_EQ(range > 0, off < 0.1F) << off;
  }
}

TEST_F(Organize, LetsCloudsPassThatHaveNoBeams) {
  Start(DriverInfo());
  std::vector<std::uint8_t> points(DriverInfo().FrameSize());
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < kColumnsOfTurn * kRings; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      state = state * 1664525u + 1013904223u;
      const float v = static_cast<float>(state >> 16) * 1e-3F - 30;
      std::memcpy(points.data() + 14 * i + 4 * axis, &v, sizeof v);
    }
  }
  unsigned passed = 0;
  for (int i = 0; i < 12; ++i) {
    ASSERT_EQ(Push(points), GST_FLOW_OK);
    const BufferPtr buffer = Pull();
    if (!buffer) continue;
    ++passed;
    EXPECT_EQ(gst_buffer_get_size(buffer.get()), points.size());
  }
  EXPECT_EQ(passed, 3u);  // after ten attempts
  EXPECT_TRUE(Warned());
  EXPECT_FALSE(Output().sensor_model);
}

TEST_F(Organize, LetsCloudsPassThatHaveNoRowsAndThoseOfAKnownSensor) {
  CloudInfo flat = DriverInfo();
  flat.width = kColumnsOfTurn * kRings;
  flat.height = 1;
  Start(flat);
  ASSERT_EQ(Push(DriverCloud(Ranges())), GST_FLOW_OK);
  EXPECT_TRUE(Pull());
  EXPECT_TRUE(Warned());
  CloudInfo known = DriverInfo();
  known.sensor_model = Model();
  gst_harness_set_src_caps(h_.get(), known.ToCaps());
  ASSERT_EQ(Push(DriverCloud(Ranges())), GST_FLOW_OK);
  EXPECT_TRUE(Pull());
  EXPECT_FALSE(Warned());
  EXPECT_EQ(Output().point_step, 14u);
}

TEST_F(Organize, DropsBuffersOfAnotherSize) {
  Start(DriverInfo());
  EXPECT_EQ(Push(std::vector<std::uint8_t>(100)), GST_FLOW_OK);
  EXPECT_FALSE(Pull());
  ASSERT_EQ(Push(DriverCloud(Ranges())), GST_FLOW_OK);
  EXPECT_TRUE(Pull());
}

TEST_F(Organize, TakesNoMoreRowsThanASensorHasBeams) {
  CloudInfo tall = DriverInfo();
  tall.width = 2;
  tall.height = 2000;
  Start(tall);
  EXPECT_TRUE(Warned());
}

TEST_F(Organize, NoGapComesBeforeTheCaps) {
  Start(DriverInfo());
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(gst_harness_push_event(h_.get(), gst_event_new_gap(0, GST_SECOND)));
    if (i == 0) {
      ASSERT_EQ(Push(DriverCloud(Ranges())), GST_FLOW_OK);
    }
  }
  EXPECT_EQ(EventsOf(h_.get()),
            (std::vector<std::string>{"stream-start", "caps", "segment", "gap"}));
}

TEST_F(Organize, EndsWithoutAnyCloud) {
  Start(DriverInfo());
  EXPECT_TRUE(gst_harness_push_event(h_.get(), gst_event_new_eos()));
  for (;;) {
    const EventPtr event(gst_harness_try_pull_event(h_.get()));
    ASSERT_TRUE(event);
    if (GST_EVENT_TYPE(event.get()) == GST_EVENT_EOS) break;
  }
}

}  // namespace
}  // namespace lidar::gst
