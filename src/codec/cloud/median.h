// SPDX-License-Identifier: LGPL-2.1-or-later
// The upper median of some values.
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace lidar::codec::cloud {

/// Returns the upper median of `values`, or 0 if there are none.
template <class T>
T MedianOf(std::vector<T> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace lidar::codec::cloud
