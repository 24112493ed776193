// SPDX-License-Identifier: LGPL-2.1-or-later
// Buffers and caps for the tests of dracoenc and dracodec.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "gst/common/buffer_map.h"
#include "gst/common/cloud_info.h"
#include "tests/core/codec/test_clouds.h"
#include "tests/support/harness.h"

namespace lidar::gst {

using test::Harness;

inline std::vector<float> PointsOf(GstBuffer* buffer, gsize step) {
  const BufferMap map(buffer, GST_MAP_READ);
  std::vector<float> points;
  for (gsize at = 0; at + step <= map.size(); at += step) {
    float p[3];
    std::memcpy(p, map.data() + at, sizeof p);
    points.insert(points.end(), p, p + 3);
  }
  return points;
}

inline GstStructure* StatsOf(GstElement* element) {
  GstStructure* stats = nullptr;
  g_object_get(element, "stats", &stats, nullptr);
  return stats;
}

inline guint64 Counter(GstElement* element, const char* name) {
  const StructurePtr stats(StatsOf(element));
  guint64 value = G_MAXUINT64;
  EXPECT_TRUE(gst_structure_get_uint64(stats.get(), name, &value)) << name;
  return value;
}

inline CloudInfo OrganisedInfo(const SensorModel& model, guint columns) {
  CloudInfo info;
  info.width = columns;
  info.height = static_cast<guint>(model.beams.size());
  info.point_step = 20;
  info.fields = test::OrganisedLayout().fields;
  info.framerate_n = 10;
  info.sensor_model = model;
  return info;
}

inline GstBuffer* OrganisedBuffer(const SensorModel& model, guint columns,
                                  const GstLidarSlice& slice) {
  const auto raw = test::RawCloud(model, test::RoomScan(model, slice.first_column, columns));
  GstBuffer* buffer = gst_buffer_new_memdup(raw.data(), raw.size());
  gst_lidar_buffer_set_slice(buffer, &slice);
  const GstClockTime time = (slice.scan_id * 8 + slice.slice_index) * 12'500 * GST_USECOND;
  gst_lidar_buffer_set_capture_time(buffer, 1'700'000'000 * GST_SECOND + time);
  GST_BUFFER_PTS(buffer) = time;
  GST_BUFFER_DURATION(buffer) = 12'500 * GST_USECOND;
  return buffer;
}

inline Harness Codec(const std::string& enc_properties) {
  Harness h(gst_harness_new_parse(
      ("dracoenc name=enc " + enc_properties + " ! dracodec name=dec").c_str()));
  return h;
}

inline double LargestDistance(const std::vector<float>& a, const std::vector<float>& b) {
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

}  // namespace lidar::gst
