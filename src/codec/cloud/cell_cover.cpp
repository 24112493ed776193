// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/cell_cover.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/codec/cloud/node_map.h"

namespace lidar::codec::cloud {
namespace {

/// Margin for the rounding of floats: grids are finer, and errors count as larger.
constexpr double kRoom = 1e-4;

double HalfOf(unsigned depth) { return static_cast<double>(std::uint64_t{1} << (depth - 1)); }

/// Is std::floor(), which is a call.
double Floor(double value) {
  const auto whole = static_cast<double>(static_cast<std::int64_t>(value));
  return whole > value ? whole - 1 : whole;
}

CellPosition OwnCell(const Point& point, const CellGrid& grid, unsigned depth) {
  const double half = HalfOf(depth);
  const double step = static_cast<double>(grid.step_m);
  CellPosition cell;
  for (unsigned k = 0; k < 3; ++k)
    cell[k] = static_cast<std::uint32_t>(Floor(static_cast<double>(point[k]) / step) + half);
  return cell;
}

double SquareDistance(const Point& a, const Point& b) {
  double square = 0;
  for (unsigned k = 0; k < 3; ++k) {
    const double d = static_cast<double>(a[k]) - static_cast<double>(b[k]);
    square += d * d;
  }
  return square;
}

/// Numbers from `first[i]` to `first[i + 1]` belong to i.
std::vector<std::uint32_t> Sums(const std::vector<std::uint32_t>& counts) {
  std::vector<std::uint32_t> first(counts.size() + 1, 0);
  for (std::size_t i = 0; i < counts.size(); ++i) first[i + 1] = first[i] + counts[i];
  return first;
}

/// Points and the cells that they may take.
class Choices {
 public:
  Choices(const std::vector<Point>& points, const CellGrid& grid, unsigned depth) {
    constexpr std::size_t kMeanChoices = 3;
    map_.Reset(kMeanChoices * points.size());
    first_of_point_.reserve(points.size() + 1);
    for (const Point& point : points) {
      first_of_point_.push_back(static_cast<std::uint32_t>(cells_.size()));
      AddPoint(point, grid, depth);
    }
    first_of_point_.push_back(static_cast<std::uint32_t>(cells_.size()));
    first_of_cell_ = Sums(left_);
    points_.resize(cells_.size());
    std::vector<std::uint32_t> next(first_of_cell_.begin(), first_of_cell_.end() - 1);
    for (std::uint32_t i = 0; i < points.size(); ++i)
      for (std::uint32_t k = first_of_point_[i]; k < first_of_point_[i + 1]; ++k)
        points_[next[cells_[k]]++] = i;
    taken_.assign(points.size(), false);
  }

  const std::vector<std::uint64_t>& codes() const { return codes_; }
  /// Returns how many of the remaining points may take this cell.
  std::uint32_t left(std::uint32_t cell) const { return left_[cell]; }
  /// Gives the cell all its remaining points, and appends them to `order`.
  void Take(std::uint32_t cell, std::vector<std::uint32_t>* order) {
    for (std::uint32_t k = first_of_cell_[cell]; k < first_of_cell_[cell + 1]; ++k) {
      const std::uint32_t point = points_[k];
      if (taken_[point]) continue;
      taken_[point] = true;
      order->push_back(point);
      for (std::uint32_t c = first_of_point_[point]; c < first_of_point_[point + 1]; ++c)
        --left_[cells_[c]];
    }
  }

 private:
  /// Visits the neighbouring cells on the point's side; others are too far.
  void AddPoint(const Point& point, const CellGrid& grid, unsigned depth) {
    const CellPosition own = OwnCell(point, grid, depth);
    AddChoice(own);
    const Point middle = grid.Middle(own, depth);
    std::array<double, 3> off{};  // squares, in cells
    std::array<double, 3> beside{};
    CellPosition side = own;
    for (unsigned k = 0; k < 3; ++k) {
      const double away = (static_cast<double>(point[k]) - static_cast<double>(middle[k])) /
                          static_cast<double>(grid.step_m);
      side[k] = away < 0 ? own[k] - 1 : own[k] + 1;
      off[k] = away * away;
      beside[k] = (1 - std::abs(away)) * (1 - std::abs(away));
    }
    // The rounding of floats decides beyond this.
    constexpr double kNever = 0.7515;
    const double bound = grid.error_m() * grid.error_m();
    for (unsigned i = 1; i < 8; ++i) {
      const double square = ((i & 1) != 0 ? beside[0] : off[0]) +
                            ((i & 2) != 0 ? beside[1] : off[1]) +
                            ((i & 4) != 0 ? beside[2] : off[2]);
      if (square > kNever) continue;
      const CellPosition cell = {(i & 1) != 0 ? side[0] : own[0], (i & 2) != 0 ? side[1] : own[1],
                                 (i & 4) != 0 ? side[2] : own[2]};
      if (SquareDistance(point, grid.Middle(cell, depth)) <= bound) AddChoice(cell);
    }
  }
  void AddChoice(const CellPosition& cell) {
    const std::uint64_t key = NodeMap::KeyOf(cell);
    std::uint32_t index = map_.Find(key);
    if (index == NodeMap::kAbsent) {
      index = static_cast<std::uint32_t>(codes_.size());
      map_.Add(key, index);
      codes_.push_back(MortonCode(cell));
      left_.push_back(0);
    }
    ++left_[index];
    cells_.push_back(index);
  }

  NodeMap map_;
  std::vector<std::uint64_t> codes_;  // of cells
  std::vector<std::uint32_t> left_;
  std::vector<std::uint32_t> first_of_point_;
  std::vector<std::uint32_t> cells_;  // point by point
  std::vector<std::uint32_t> first_of_cell_;
  std::vector<std::uint32_t> points_;  // cell by cell
  std::vector<bool> taken_;
};

}  // namespace

CellGrid CellGrid::ForError(double error_m) {
  const double step = (1 - 2 * kRoom) * 2 * error_m / std::sqrt(3.0);
  return {std::clamp(static_cast<float>(step), kFinest, kCoarsest)};
}

double CellGrid::error_m() const {
  return static_cast<double>(step_m) * std::sqrt(3.0) / 2 * (1 + kRoom);
}

Point CellGrid::Middle(const CellPosition& cell, unsigned depth) const {
  const double half = HalfOf(depth);
  Point point;
  for (unsigned k = 0; k < 3; ++k)
    point[k] = static_cast<float>((static_cast<double>(cell[k]) - half + 0.5) *
                                  static_cast<double>(step_m));
  return point;
}

unsigned CellGrid::DepthFor(double farthest_m) const {
  const double steps = farthest_m / static_cast<double>(step_m) + 2;
  unsigned depth = 1;
  while (depth <= kMostDepth && HalfOf(depth) < steps) ++depth;
  return depth;
}

bool CellGrid::Reaches(double farthest_m) const {
  return farthest_m / static_cast<double>(step_m) + 2 <= HalfOf(kMostDepth);
}

bool CellGrid::Holds(const Point& point) const {
  const Point middle = Middle(OwnCell(point, *this, kMostDepth), kMostDepth);
  return SquareDistance(point, middle) <= error_m() * error_m();
}

void CoverByOwnCells(const std::vector<Point>& points, const CellGrid& grid, unsigned depth,
                     CoveredPoints* covered) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted;
  sorted.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i)
    sorted.emplace_back(MortonCode(OwnCell(points[i], grid, depth)), i);
  std::sort(sorted.begin(), sorted.end());
  covered->cells.Clear();
  covered->cells.depth = depth;
  covered->order.clear();
  for (const auto& [code, point] : sorted) {
    covered->order.push_back(point);
    covered->cells.AddPoint(code);
  }
}

void CoverByFewCells(const std::vector<Point>& points, const CellGrid& grid, unsigned depth,
                     CoveredPoints* covered) {
  Choices choices(points, grid, depth);
  // Lists of cells by the number of points that they may take; the numbers only fall.
  std::vector<std::vector<std::uint32_t>> queues;
  for (std::uint32_t i = 0; i < choices.codes().size(); ++i) {
    const std::uint32_t count = choices.left(i);
    if (count >= queues.size()) queues.resize(count + 1);
    queues[count].push_back(i);
  }
  struct Taken {
    std::uint64_t code;
    std::size_t first;  // of its points
    std::size_t end;
  };
  std::vector<Taken> taken;
  std::vector<std::uint32_t> order;
  order.reserve(points.size());
  for (std::size_t count = queues.size(); count-- > 1;) {
    while (!queues[count].empty()) {
      const std::uint32_t cell = queues[count].back();
      queues[count].pop_back();
      const std::uint32_t left = choices.left(cell);
      if (left > 0 && left < count) queues[left].push_back(cell);
      if (left < count) continue;
      const std::size_t first = order.size();
      choices.Take(cell, &order);
      taken.push_back({choices.codes()[cell], first, order.size()});
    }
  }
  std::sort(taken.begin(), taken.end(),
            [](const Taken& a, const Taken& b) { return a.code < b.code; });
  covered->cells.Clear();
  covered->cells.depth = depth;
  covered->order.clear();
  for (const Taken& t : taken) {
    covered->cells.codes.push_back(t.code);
    covered->cells.counts.push_back(static_cast<std::uint32_t>(t.end - t.first));
    const auto begin = order.begin();
    covered->order.insert(covered->order.end(), begin + static_cast<std::ptrdiff_t>(t.first),
                          begin + static_cast<std::ptrdiff_t>(t.end));
  }
}

}  // namespace lidar::codec::cloud
