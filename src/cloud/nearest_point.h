// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the distance from a point to the nearest point of a cloud.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lidar {

/// A k-d tree of the points in `xyz`. Each point is three finite floats. `xyz` must outlive the
/// tree.
class NearestPoint {
 public:
  explicit NearestPoint(const std::vector<float>& xyz);
  /// Returns the distance from `point` to the nearest point of the cloud, or infinity if the cloud
  /// is empty.
  double DistanceFrom(const float* point) const;

 private:
  void Arrange(std::size_t begin, std::size_t end, unsigned axis);
  void Search(const float* point, std::size_t begin, std::size_t end, unsigned axis,
              double* best) const;
  const float* At(std::size_t i) const { return xyz_ + 3 * std::size_t{order_[i]}; }

  const float* xyz_;
  // The indices of the points. The point in the middle of a range divides the range.
  std::vector<std::uint32_t> order_;
};

}  // namespace lidar
