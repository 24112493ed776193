// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/demo/cloud_compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <vector>

#include "src/cloud/point_math.h"

namespace lidar::demo {
namespace {

bool IsMissing(const float* p) { return !IsReturn({p[0], p[1], p[2]}); }

void AddError(Comparison* c, double error) {
  ++c->points;
  c->max_error_m = std::max(c->max_error_m, error);
  c->sum_error_m += error;
}

Comparison ComparePlaces(const Cloud& sent, const Cloud& received) {
  Comparison c;
  for (std::size_t i = 0; i + 2 < sent.xyz.size(); i += 3) {
    const float* a = &sent.xyz[i];
    const float* b = &received.xyz[i];
    const bool a_missing = IsMissing(a);
    const bool b_missing = IsMissing(b);
    c.missing += !a_missing && b_missing;
    c.added += a_missing && !b_missing;
    if (!a_missing && !b_missing) AddError(&c, std::sqrt(SquaredDistance(a, b)));
  }
  return c;
}

/// The points of a cloud, sorted into cubes with an edge of `edge_m`. A search for the nearest
/// point then visits only 27 cubes.
class Grid {
 public:
  Grid(const Cloud& cloud, double edge_m) : edge_m_(edge_m) {
    for (std::size_t i = 0; i + 2 < cloud.xyz.size(); i += 3)
      if (!IsMissing(&cloud.xyz[i])) cells_[Key(CellOf(&cloud.xyz[i]))].push_back(&cloud.xyz[i]);
  }

  /// Returns the distance from `p` to the nearest point, or infinity if no point is within
  /// `edge_m`.
  double DistanceToNearest(const float* p) const {
    const Cell centre = CellOf(p);
    double best = std::numeric_limits<double>::infinity();
    for (std::int64_t i = 0; i < 27; ++i) {
      const auto found = cells_.find(
          Key({centre[0] + i % 3 - 1, centre[1] + i / 3 % 3 - 1, centre[2] + i / 9 - 1}));
      if (found == cells_.end()) continue;
      for (const float* q : found->second) best = std::min(best, SquaredDistance(p, q));
    }
    best = std::sqrt(best);
    return best <= edge_m_ ? best : std::numeric_limits<double>::infinity();
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell CellOf(const float* p) const {
    Cell cell{};
    for (std::size_t i = 0; i < 3; ++i)
      cell[i] = static_cast<std::int64_t>(std::floor(double{p[i]} / edge_m_));
    return cell;
  }
  static std::uint64_t Key(const Cell& cell) {
    constexpr std::int64_t kMask = (std::int64_t{1} << 21) - 1;
    return static_cast<std::uint64_t>((cell[0] & kMask) << 42 | (cell[1] & kMask) << 21 |
                                      (cell[2] & kMask));
  }

  double edge_m_;
  std::unordered_map<std::uint64_t, std::vector<const float*>> cells_;
};

Comparison CompareNearest(const Cloud& sent, const Cloud& received, double reach_m) {
  Comparison c;
  const Grid there(received, reach_m);
  for (std::size_t i = 0; i + 2 < sent.xyz.size(); i += 3) {
    if (IsMissing(&sent.xyz[i])) continue;
    const double error = there.DistanceToNearest(&sent.xyz[i]);
    if (std::isinf(error)) {
      ++c.missing;
    } else {
      AddError(&c, error);
    }
  }
  const Grid back(sent, reach_m);
  for (std::size_t i = 0; i + 2 < received.xyz.size(); i += 3) {
    if (IsMissing(&received.xyz[i])) continue;
    const double error = back.DistanceToNearest(&received.xyz[i]);
    c.added += std::isinf(error);
    if (!std::isinf(error)) c.max_error_m = std::max(c.max_error_m, error);
  }
  return c;
}

}  // namespace

Comparison& Comparison::operator+=(const Comparison& o) {
  points += o.points;
  missing += o.missing;
  added += o.added;
  max_error_m = std::max(max_error_m, o.max_error_m);
  sum_error_m += o.sum_error_m;
  return *this;
}

Comparison Compare(const Cloud& sent, const Cloud& received, double reach_m) {
  const bool same_shape = sent.height == received.height && sent.width == received.width;
  return same_shape && sent.height > 1 ? ComparePlaces(sent, received)
                                       : CompareNearest(sent, received, reach_m);
}

}  // namespace lidar::demo
