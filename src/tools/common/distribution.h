// SPDX-License-Identifier: LGPL-2.1-or-later
// Computes percentiles of measured values.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace lidar::tools {

/// A set of measured values. Keeps every value, in four bytes each.
class Distribution {
 public:
  void Add(double value) { values_.push_back(static_cast<float>(value)); }
  void Clear() { values_.clear(); }
  std::size_t count() const { return values_.size(); }

  /// Returns the percentile `p`, from 0 to 100, by the nearest-rank method. Returns 0 if there are
  /// no values.
  double Percentile(double p) const {
    if (values_.empty()) return 0;
    std::vector<float> copy = values_;
    const double rank = std::ceil(p / 100 * static_cast<double>(copy.size()));
    const auto index = std::min(copy.size() - 1, static_cast<std::size_t>(std::max(rank, 1.0)) - 1);
    const auto nth = copy.begin() + static_cast<std::ptrdiff_t>(index);
    std::nth_element(copy.begin(), nth, copy.end());
    return static_cast<double>(*nth);
  }
  double Max() const { return Percentile(100); }

 private:
  std::vector<float> values_;
};

}  // namespace lidar::tools
