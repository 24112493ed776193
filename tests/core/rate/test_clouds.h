// SPDX-License-Identifier: LGPL-2.1-or-later
// Small point clouds as messages, for the tests of recordings.
#pragma once
#include <vector>

#include "src/cdr/point_cloud2.h"

namespace lidar::tools {

struct TestPoint {
  float x, y, z, intensity;
};

inline cdr::PointCloud2 CloudOf(const std::vector<TestPoint>& points, std::uint32_t width) {
  cdr::PointCloud2 cloud;
  cloud.layout.width = width;
  cloud.layout.height = static_cast<std::uint32_t>(points.size()) / width;
  cloud.layout.fields = {{"x", 0, 7, 1}, {"y", 4, 7, 1}, {"z", 8, 7, 1}, {"intensity", 12, 7, 1}};
  cloud.layout.point_step = sizeof(TestPoint);
  cloud.layout.row_step = width * cloud.layout.point_step;
  cloud.data = {reinterpret_cast<const std::uint8_t*>(points.data()),
                points.size() * sizeof(TestPoint)};
  return cloud;
}

}  // namespace lidar::tools
