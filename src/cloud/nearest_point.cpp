// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cloud/nearest_point.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "src/cloud/point_math.h"

namespace lidar {

NearestPoint::NearestPoint(const std::vector<float>& xyz)
    : xyz_(xyz.data()), order_(xyz.size() / 3) {
  std::iota(order_.begin(), order_.end(), 0U);
  Arrange(0, order_.size(), 0);
}

void NearestPoint::Arrange(std::size_t begin, std::size_t end, unsigned axis) {
  if (end - begin < 2) return;
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [this](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
    return xyz_[3 * std::size_t{a} + axis] < xyz_[3 * std::size_t{b} + axis];
  });
  Arrange(begin, middle, (axis + 1) % 3);
  Arrange(middle + 1, end, (axis + 1) % 3);
}

double NearestPoint::DistanceFrom(const float* point) const {
  double best = std::numeric_limits<double>::infinity();
  Search(point, 0, order_.size(), 0, &best);
  return std::sqrt(best);
}

void NearestPoint::Search(const float* point, std::size_t begin, std::size_t end, unsigned axis,
                          double* best) const {
  if (begin >= end) return;
  const std::size_t middle = begin + (end - begin) / 2;
  *best = std::min(*best, SquaredDistance(point, At(middle)));
  const double side = static_cast<double>(point[axis]) - static_cast<double>(At(middle)[axis]);
  const unsigned next = (axis + 1) % 3;
  if (side < 0) {
    Search(point, begin, middle, next, best);
    if (side * side < *best) Search(point, middle + 1, end, next, best);
  } else {
    Search(point, middle + 1, end, next, best);
    if (side * side < *best) Search(point, begin, middle, next, best);
  }
}

}  // namespace lidar
