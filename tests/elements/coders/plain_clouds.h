// SPDX-License-Identifier: LGPL-2.1-or-later
// Clouds with one row and without a sensor model, for tests of the coders that accept them.
#pragma once
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/elements/coders/coder_harness.h"

namespace lidar::gst {

inline CloudInfo XyzInfo(guint points) {
  CloudInfo info;
  info.width = points;
  info.point_step = 16;
  info.fields = *PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,intensity:F32:12");
  info.framerate_n = 10;
  return info;
}

/// Returns a buffer with x, y, z and an intensity of 0.5 for each point.
inline GstBuffer* PlainBuffer(const std::vector<float>& xyz) {
  std::vector<float> raw;
  for (std::size_t i = 0; i + 2 < xyz.size(); i += 3)
    raw.insert(raw.end(), {xyz[i], xyz[i + 1], xyz[i + 2], 0.5F});
  GstBuffer* buffer = gst_buffer_new_memdup(raw.data(), raw.size() * sizeof(float));
  GST_BUFFER_PTS(buffer) = 0;
  GST_BUFFER_DURATION(buffer) = 100 * GST_MSECOND;
  return buffer;
}

/// Computes, for each point of `a`, the distance to the nearest point of `b`. Returns the largest
/// of these distances.
inline double LargestGap(const std::vector<float>& a, const std::vector<float>& b) {
  double largest = 0;
  for (std::size_t i = 0; i + 2 < a.size(); i += 3) {
    double nearest = 1e9;
    for (std::size_t k = 0; k + 2 < b.size(); k += 3) {
      const double x = static_cast<double>(a[i]) - static_cast<double>(b[k]);
      const double y = static_cast<double>(a[i + 1]) - static_cast<double>(b[k + 1]);
      const double z = static_cast<double>(a[i + 2]) - static_cast<double>(b[k + 2]);
      nearest = std::min(nearest, std::sqrt(x * x + y * y + z * z));
    }
    largest = std::max(largest, nearest);
  }
  return largest;
}

inline std::vector<float> RandomPoints(std::size_t count, float extent) {
  std::mt19937 random(11);
  std::vector<float> xyz;
  for (std::size_t i = 0; i < 3 * count; ++i)
    xyz.push_back(extent * (static_cast<float>(random() % 65'536) / 65'536 - 0.5F));
  return xyz;
}

}  // namespace lidar::gst
