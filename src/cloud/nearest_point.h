// SPDX-License-Identifier: LGPL-2.1-or-later
// Distances from points to the nearest point of a cloud.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lidar {

/// A k-d tree over the points of `xyz` (three floats each, finite), which must outlive it.
class NearestPoint {
 public:
  explicit NearestPoint(const std::vector<float>& xyz);
  /// Distance from `point` to the nearest point of the cloud; infinity if the cloud is empty.
  double DistanceFrom(const float* point) const;

 private:
  void Arrange(std::size_t begin, std::size_t end, unsigned axis);
  void Search(const float* point, std::size_t begin, std::size_t end, unsigned axis,
              double* best) const;
  const float* At(std::size_t i) const { return xyz_ + 3 * std::size_t{order_[i]}; }

  const float* xyz_;
  std::vector<std::uint32_t> order_;  // indices; the point in the middle of a range divides it
};

}  // namespace lidar
