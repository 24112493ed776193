// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <cstring>

#include "common/buffer_map.h"
#include "common/cloud_info.h"
#include "support/harness.h"
#include "test_clouds.h"

namespace lidar::gst {
namespace {

using test::Harness;

std::vector<float> PointsOf(GstBuffer* buffer, gsize step) {
  const BufferMap map(buffer, GST_MAP_READ);
  std::vector<float> points;
  for (gsize at = 0; at + step <= map.size(); at += step) {
    float p[3];
    std::memcpy(p, map.data() + at, sizeof p);
    points.insert(points.end(), p, p + 3);
  }
  return points;
}

GstStructure* StatsOf(GstElement* element) {
  GstStructure* stats = nullptr;
  g_object_get(element, "stats", &stats, nullptr);
  return stats;
}

guint64 Counter(GstElement* element, const char* name) {
  const StructurePtr stats(StatsOf(element));
  guint64 value = G_MAXUINT64;
  EXPECT_TRUE(gst_structure_get_uint64(stats.get(), name, &value)) << name;
  return value;
}

CloudInfo OrganisedInfo(const SensorModel& model, guint columns) {
  CloudInfo info;
  info.width = columns;
  info.height = static_cast<guint>(model.beams.size());
  info.point_step = 20;
  info.fields = test::OrganisedLayout().fields;
  info.framerate_n = 10;
  info.sensor_model = model;
  return info;
}

GstBuffer* OrganisedBuffer(const SensorModel& model, guint columns, const GstLidarSlice& slice) {
  const auto raw = test::RawCloud(model, test::RoomScan(model, slice.first_column, columns));
  GstBuffer* buffer = gst_buffer_new_memdup(raw.data(), raw.size());
  gst_lidar_buffer_set_slice(buffer, &slice);
  const GstClockTime time = (slice.scan_id * 8 + slice.slice_index) * 12'500 * GST_USECOND;
  gst_lidar_buffer_set_capture_time(buffer, 1'700'000'000 * GST_SECOND + time);
  GST_BUFFER_PTS(buffer) = time;
  GST_BUFFER_DURATION(buffer) = 12'500 * GST_USECOND;
  return buffer;
}

Harness Codec(const std::string& enc_properties) {
  Harness h(gst_harness_new_parse(
      ("dracoenc name=enc " + enc_properties + " ! dracodec name=dec").c_str()));
  return h;
}

double LargestDistance(const std::vector<float>& a, const std::vector<float>& b) {
  double largest = 0;
  for (std::size_t i = 0; i + 2 < a.size(); i += 3) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double d = static_cast<double>(a[i + k]) - static_cast<double>(b[i + k]);
      sum += d * d;
    }
    largest = std::max(largest, std::sqrt(sum));
  }
  return largest;
}

struct ErrorCase {
  const char* coder;
  std::uint32_t unit_mm;
  double max_error_m;
};
class OrganisedScans : public ::testing::TestWithParam<ErrorCase> {};

TEST_P(OrganisedScans, ComeBackWithinTheErrorSliceBySlice) {
  const ErrorCase& c = GetParam();
  const SensorModel model = test::RoomSensor(32, c.unit_mm);
  const Harness h =
      Codec("range-coder=" + std::string(c.coder) + " max-error=" + std::to_string(c.max_error_m));
  const CapsPtr caps(OrganisedInfo(model, 64).ToCaps());
  gst_harness_set_src_caps(h.get(), gst_caps_ref(caps.get()));
  for (guint i = 0; i < 8; ++i) {
    GstBuffer* input = OrganisedBuffer(model, 64, {7, i, 8, 64 * i});
    const auto before = PointsOf(input, 20);
    ASSERT_EQ(gst_harness_push(h.get(), input), GST_FLOW_OK);
    const BufferPtr output(gst_harness_pull(h.get()));
    EXPECT_LE(LargestDistance(before, PointsOf(output.get(), 20)), c.max_error_m + 1e-5);
    GstLidarSlice slice{};
    ASSERT_TRUE(gst_lidar_buffer_get_slice(output.get(), &slice));
    EXPECT_EQ(slice.scan_id, 7U);
    EXPECT_EQ(slice.slice_index, i);
    EXPECT_EQ(slice.first_column, 64 * i);
    EXPECT_EQ(GST_BUFFER_PTS(output.get()), (56 + i) * 12'500 * GST_USECOND);
    EXPECT_EQ(gst_lidar_buffer_get_capture_time(output.get()),
              1'700'000'000 * GST_SECOND + (56 + i) * 12'500 * GST_USECOND);
  }
  const CapsPtr out(gst_pad_get_current_caps(h->sinkpad));
  const auto info = CloudInfo::FromCaps(out.get());
  ASSERT_TRUE(info);
  EXPECT_EQ(info->width, 64U);
  EXPECT_EQ(info->height, 32U);
  EXPECT_EQ(info->fields, test::OrganisedLayout().fields);
  EXPECT_TRUE(info->sensor_model);
}
INSTANTIATE_TEST_SUITE_P(
    All, OrganisedScans,
    ::testing::Values(ErrorCase{"draco", 1, 0.02}, ErrorCase{"draco", 8, 0.02},
                      ErrorCase{"residual", 8, 0.05}, ErrorCase{"adaptive", 1, 0.02},
                      ErrorCase{"adaptive", 8, 0.02}, ErrorCase{"adaptive", 1, 0.0003},
                      ErrorCase{"draco", 1, 0.0015}, ErrorCase{"draco", 8, 0.001}));

TEST(DracoElements, GiveGapsBackAsZeros) {
  const SensorModel model = test::RoomSensor();
  const Harness h = Codec("");
  const CapsPtr caps(OrganisedInfo(model, 512).ToCaps());
  gst_harness_set_src_caps(h.get(), gst_caps_ref(caps.get()));
  GstBuffer* input = OrganisedBuffer(model, 512, {0, 0, 1, 0});
  const auto before = PointsOf(input, 20);
  const BufferPtr output(gst_harness_push_and_pull(h.get(), input));
  const auto after = PointsOf(output.get(), 20);
  ASSERT_EQ(after.size(), before.size());
  std::size_t gaps = 0;
  for (std::size_t i = 0; i < before.size(); i += 3) {
    const bool gap = before[i] == 0 && before[i + 1] == 0 && before[i + 2] == 0;
    gaps += gap ? 1 : 0;
    EXPECT_EQ(gap, after[i] == 0 && after[i + 1] == 0 && after[i + 2] == 0);
  }
  EXPECT_GT(gaps, 300U);
}

TEST(DracoElements, DropAndCountADamagedSliceAndGoOn) {
  const SensorModel model = test::RoomSensor();
  const Harness enc(gst_harness_new("dracoenc"));
  const Harness dec(gst_harness_new("dracodec"));
  const CapsPtr caps(OrganisedInfo(model, 64).ToCaps());
  gst_harness_set_src_caps(enc.get(), gst_caps_ref(caps.get()));
  std::vector<BufferPtr> slices;
  for (guint i = 0; i < 3; ++i) {
    slices.emplace_back(
        gst_harness_push_and_pull(enc.get(), OrganisedBuffer(model, 64, {0, i, 8, 64 * i})));
  }
  gst_harness_set_src_caps(dec.get(), gst_pad_get_current_caps(enc->sinkpad));
  BufferPtr damaged(gst_buffer_copy_deep(slices[1].get()));
  {
    BufferMap map(damaged.get(), GST_MAP_WRITE);
    map.data()[map.size() / 2] ^= 0xFF;
    map.data()[0] = 0xF0;
  }
  EXPECT_EQ(gst_harness_push(dec.get(), slices[0].release()), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_push(dec.get(), damaged.release()), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_push(dec.get(), slices[2].release()), GST_FLOW_OK);
  EXPECT_EQ(gst_harness_buffers_received(dec.get()), 2U);
  EXPECT_EQ(Counter(dec->element, "slices-dropped"), 1U);
  gst_buffer_unref(gst_harness_pull(dec.get()));
  const BufferPtr after(gst_harness_pull(dec.get()));
  EXPECT_TRUE(GST_BUFFER_IS_DISCONT(after.get()));
}

}  // namespace
}  // namespace lidar::gst
