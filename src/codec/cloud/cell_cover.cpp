// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/cell_cover.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "src/codec/cloud/node_map.h"

namespace lidar::codec::cloud {
namespace {

/// A margin for the rounding of floats, as a part of the error. The error of a grid is assumed to
/// be larger by this part. ForError() makes the grid finer by twice this part.
constexpr double kRoom = 1e-4;

/// Returns std::floor(value), without a function call.
double Floor(double value) {
  const auto whole = static_cast<double>(static_cast<std::int64_t>(value));
  return whole > value ? whole - 1 : whole;
}

CellPosition OwnCell(const Point& point, const CellGrid& grid, unsigned depth) {
  const double half = CellGrid::HalfOf(depth);
  const double step = static_cast<double>(grid.step_m);
  CellPosition cell;
  for (unsigned k = 0; k < 3; ++k)
    cell[k] = static_cast<std::uint32_t>(
        static_cast<std::int64_t>(Floor(static_cast<double>(point[k]) / step) + half));
  return cell;
}

/// Returns the index of the first entry of each group in a list. Group `i` has `counts[i]` entries.
std::vector<std::uint32_t> Sums(const std::vector<std::uint32_t>& counts) {
  std::vector<std::uint32_t> first(counts.size() + 1, 0);
  for (std::size_t i = 0; i < counts.size(); ++i) first[i + 1] = first[i] + counts[i];
  return first;
}

/// Finds the cells whose middles are within the error of a point.
class NearCells {
 public:
  static constexpr std::size_t kMost = 8;
  /// The number of cells around a cell, with the cell itself. The cell that is x, y and z steps
  /// away has the place 13 + x + 3 y + 9 z.
  static constexpr unsigned kAround = 27;
  /// A point's own cell, which is the cell that contains the point.
  struct Own {
    std::array<double, 3> cell;  // in steps from the middle of the grid
    std::uint64_t key = 0;
  };

  NearCells(const CellGrid& grid, unsigned depth)
      : grid_(grid),
        step_(static_cast<double>(grid.step_m)),
        half_(CellGrid::HalfOf(depth)),
        square_bound_(grid.error_m() * grid.error_m()) {}

  /// Writes the key of the point's own cell to `keys`, then the keys of those neighbours whose
  /// middles are near enough. Returns the end of the keys.
  std::uint64_t* Write(const Point& point, std::uint64_t* keys) const {
    const Own own = OwnOf(point);
    const Sides sides = SidesOf(point, own);
    *keys++ = own.key;
    // There is no jump for each neighbour, because a processor would often mispredict it.
    for (unsigned i = 1; i < kMost; ++i) {
      std::uint64_t key = own.key;
      for (unsigned k = 0; k < 3; ++k) {
        const std::uint64_t step = sides.is_below[k] ? 0 - kSteps[k] : kSteps[k];
        key += (i >> k & 1) != 0 ? step : 0;
      }
      *keys = key;
      keys += IsNear(sides, i) ? 1 : 0;
    }
    return keys;
  }
  Own OwnOf(const Point& point) const {
    Own own;
    for (unsigned k = 0; k < 3; ++k) {
      own.cell[k] = Floor(static_cast<double>(point[k]) / step_);
      own.key += static_cast<std::uint64_t>(static_cast<std::int64_t>(own.cell[k] + half_) + 1) *
                 kSteps[k];
    }
    return own;
  }
  /// Returns a bit for each cell around the point's own cell. It is 1 if the middle of the cell is
  /// near enough.
  std::uint32_t AroundOf(const Point& point, const Own& own) const {
    constexpr std::array<int, 3> kPlaces = {1, 3, 9};
    const Sides sides = SidesOf(point, own);
    std::uint32_t around = 0;
    for (unsigned i = 1; i < kMost; ++i) {
      int place = kAround / 2;
      for (unsigned k = 0; k < 3; ++k) {
        const int step = sides.is_below[k] ? -kPlaces[k] : kPlaces[k];
        place += (i >> k & 1) != 0 ? step : 0;
      }
      around |= (IsNear(sides, i) ? 1U : 0U) << place;
    }
    return around;
  }
  /// Returns the key of the cell that has `place` among the cells around the cell of `key`.
  static std::uint64_t KeyAround(std::uint64_t key, unsigned place) {
    return key - kSteps[0] - kSteps[1] - kSteps[2] + place % 3 * kSteps[0] +
           place / 3 % 3 * kSteps[1] + place / 9 * kSteps[2];
  }

 private:
  static constexpr std::array<std::uint64_t, 3> kSteps = {NodeMap::kStepX, NodeMap::kStepY,
                                                          NodeMap::kStepZ};
  /// Along each axis, two cells can be near enough: the point's own cell, and the neighbour on the
  /// side on which the point is.
  struct Sides {
    std::array<std::array<double, 3>, 2> squares;  // squared distances from the middles
    std::array<bool, 3> is_below;                  // whether the neighbour is below the own cell
  };

  Sides SidesOf(const Point& point, const Own& own) const {
    Sides sides;
    for (unsigned k = 0; k < 3; ++k) {
      const auto at = static_cast<double>(point[k]);
      const double off = at - grid_.MiddleFromCentre(own.cell[k]);
      const double beside = at - grid_.MiddleFromCentre(own.cell[k] + std::copysign(1.0, off));
      sides.squares[0][k] = off * off;
      sides.squares[1][k] = beside * beside;
      sides.is_below[k] = off < 0;
    }
    return sides;
  }
  /// Returns true if the middle of a cell is near enough. Bit k of `i` is 1 if the cell is the
  /// neighbour along axis k, and 0 if it is the own cell.
  bool IsNear(const Sides& sides, unsigned i) const {
    return !(sides.squares[i & 1][0] + sides.squares[i >> 1 & 1][1] + sides.squares[i >> 2][2] >
             square_bound_);
  }

  CellGrid grid_;
  double step_;
  double half_;
  double square_bound_;  // largest squared distance from a cell's middle
};

/// Points, grouped by their own cells. Merge() joins cells.
class OwnCells {
 public:
  OwnCells(const std::vector<Point>& points, const CellGrid& grid, unsigned depth) {
    constexpr std::size_t kUsual = 8;  // points per cell
    const NearCells near(grid, depth);
    map_.Reset(points.size() / kUsual);
    cell_of_point_.reserve(points.size());
    for (const Point& point : points) {
      const NearCells::Own own = near.OwnOf(point);
      const std::uint32_t index = IndexOf(own.key);
      Cell& cell = cells_[index];
      ++cell.count;
      // `around` has the cells that are near enough to all points so far. It is soon 0 in most
      // cells, because they have points on all sides.
      if (cell.around != 0) cell.around &= near.AroundOf(point, own);
      cell_of_point_.push_back(index);
    }
  }
  /// Gives the points of a cell to a neighbour that is near enough to all of them. If there are
  /// several such neighbours, the one with the most points gets them.
  void Merge() {
    for (std::uint32_t i = 0; i < cells_.size(); ++i) {
      std::uint32_t best = i;
      std::uint32_t most = 0;
      for (std::uint32_t around = cells_[i].around; around != 0; around &= around - 1) {
        const auto place = static_cast<unsigned>(__builtin_ctz(around));
        const std::uint32_t other = map_.Find(NearCells::KeyAround(cells_[i].key, place));
        if (other == NodeMap::kAbsent || cells_[other].count <= most) continue;
        most = cells_[other].count;
        best = other;
      }
      if (best == i) continue;
      cells_[best].count += cells_[i].count;
      cells_[best].around = 0;
      cells_[i].count = 0;
      cells_[i].into = best;
    }
  }
  void List(unsigned depth, CoveredPoints* covered) const {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted;  // code, index
    for (std::uint32_t i = 0; i < cells_.size(); ++i)
      if (cells_[i].count > 0)
        sorted.emplace_back(MortonCode(NodeMap::PositionOf(cells_[i].key)), i);
    std::sort(sorted.begin(), sorted.end());
    covered->cells.Clear();
    covered->cells.depth = depth;
    std::vector<std::uint32_t> next(cells_.size());  // index of a cell's next point in the order
    std::uint32_t sum = 0;
    for (const auto& [code, i] : sorted) {
      covered->cells.codes.push_back(code);
      covered->cells.counts.push_back(cells_[i].count);
      next[i] = sum;
      sum += cells_[i].count;
    }
    covered->order.resize(cell_of_point_.size());
    for (std::uint32_t point = 0; point < cell_of_point_.size(); ++point)
      covered->order[next[cells_[cell_of_point_[point]].into]++] = point;
  }

 private:
  struct Cell {
    std::uint64_t key;
    std::uint32_t count;
    std::uint32_t around;  // bits of the cells around it that are near enough to all of its points
    std::uint32_t into;    // the cell that now has its points
  };

  std::uint32_t IndexOf(std::uint64_t key) {
    std::uint32_t index = map_.Find(key);
    if (index != NodeMap::kAbsent) return index;
    index = static_cast<std::uint32_t>(cells_.size());
    map_.Add(key, index);
    cells_.push_back({key, 0, UINT32_MAX, index});
    return index;
  }

  NodeMap map_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> cell_of_point_;
};

/// Points, and the cells to which each of them may belong.
class Choices {
 public:
  Choices(const std::vector<Point>& points, const CellGrid& grid, unsigned depth) {
    FindCells(points, NearCells(grid, depth));
    first_of_cell_ = Sums(left_);
    points_.resize(cells_.size());
    std::vector<std::uint32_t> next(first_of_cell_.begin(), first_of_cell_.end() - 1);
    for (std::uint32_t i = 0; i < points.size(); ++i)
      for (std::uint32_t k = first_of_point_[i]; k < first_of_point_[i + 1]; ++k)
        points_[next[cells_[k]]++] = i;
    taken_.assign(points.size(), 0);
  }

  std::uint32_t size() const { return static_cast<std::uint32_t>(keys_.size()); }
  std::uint64_t CodeOf(std::uint32_t cell) const {
    return MortonCode(NodeMap::PositionOf(keys_[cell]));
  }
  /// Returns the number of remaining points that may belong to the cell.
  std::uint32_t left(std::uint32_t cell) const { return left_[cell]; }
  /// Assigns all remaining points that may belong to the cell to it, and appends them to `order`.
  void Take(std::uint32_t cell, std::vector<std::uint32_t>* order) {
    for (std::uint32_t k = first_of_cell_[cell]; k < first_of_cell_[cell + 1]; ++k) {
      const std::uint32_t point = points_[k];
      if (taken_[point] != 0) continue;
      taken_[point] = 1;
      order->push_back(point);
      for (std::uint32_t c = first_of_point_[point]; c < first_of_point_[point + 1]; ++c)
        --left_[cells_[c]];
    }
  }

 private:
  /// Fills the lists of cells and choices. The keys of several points are computed before the first
  /// of these keys is looked up, so that no look-up waits for its key.
  void FindCells(const std::vector<Point>& points, const NearCells& near) {
    constexpr std::size_t kAtOnce = 64;
    constexpr std::size_t kUsual = 4;  // usual number of near cells of a point
    std::array<std::uint64_t, kAtOnce * NearCells::kMost> keys;
    map_.Reset(points.size() / 2);
    first_of_point_.reserve(points.size() + 1);
    cells_.reserve(kUsual * points.size());
    first_of_point_.push_back(0);
    for (std::size_t first = 0; first < points.size(); first += kAtOnce) {
      const auto before = static_cast<std::uint32_t>(cells_.size());
      std::uint64_t* end = keys.data();
      for (std::size_t i = first; i < std::min(first + kAtOnce, points.size()); ++i) {
        end = near.Write(points[i], end);
        first_of_point_.push_back(before + static_cast<std::uint32_t>(end - keys.data()));
      }
      for (const std::uint64_t* key = keys.data(); key != end; ++key) AddChoice(*key);
    }
  }
  void AddChoice(std::uint64_t key) {
    std::uint32_t index = map_.Find(key);
    if (index == NodeMap::kAbsent) {
      index = size();
      map_.Add(key, index);
      keys_.push_back(key);
      left_.push_back(0);
    }
    ++left_[index];
    cells_.push_back(index);
  }

  NodeMap map_;
  std::vector<std::uint64_t> keys_;  // keys of the cells
  std::vector<std::uint32_t> left_;
  std::vector<std::uint32_t> first_of_point_;
  std::vector<std::uint32_t> cells_;  // the cells of each point, point by point
  std::vector<std::uint32_t> first_of_cell_;
  std::vector<std::uint32_t> points_;  // the points of each cell, cell by cell
  std::vector<std::uint8_t> taken_;
};

/// Stacks of cells. Each stack has the cells that may still get a certain number of points. This
/// number never rises for a cell.
class CellQueues {
 public:
  explicit CellQueues(const Choices& choices) : next_(choices.size()) {
    for (std::uint32_t i = 0; i < next_.size(); ++i) Push(i, choices.left(i));
  }
  std::uint32_t most() const { return static_cast<std::uint32_t>(first_.size()) - 1; }
  bool empty(std::uint32_t count) const { return first_[count] == kEnd; }
  void Push(std::uint32_t cell, std::uint32_t count) {
    if (count >= first_.size()) first_.resize(count + 1, kEnd);
    next_[cell] = first_[count];
    first_[count] = cell;
  }
  std::uint32_t Pop(std::uint32_t count) {
    const std::uint32_t cell = first_[count];
    first_[count] = next_[cell];
    return cell;
  }

 private:
  static constexpr std::uint32_t kEnd = UINT32_MAX;
  std::vector<std::uint32_t> first_ = {kEnd};  // the top of each stack, by number of points
  std::vector<std::uint32_t> next_;            // the next cell in the same stack, by cell
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
  Point point;
  for (unsigned k = 0; k < 3; ++k) point[k] = static_cast<float>(Middle(cell[k], depth));
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

double CellGrid::SurelyHolds() const {
  // Each coordinate of a cell's middle is rounded, which changes it by at most half of kRounding
  // times its size. The sum of the three changes must be within the margin of error_m().
  constexpr double kRounding = static_cast<double>(std::numeric_limits<float>::epsilon());
  return 3 * (static_cast<double>(step_m) * kRoom / kRounding - static_cast<double>(step_m));
}

bool CellGrid::Holds(const Point& point) const {
  const CellPosition own = OwnCell(point, *this, kMostDepth);
  double square = 0;
  for (unsigned k = 0; k < 3; ++k) {
    const double off = static_cast<double>(point[k]) - Middle(own[k], kMostDepth);
    square += off * off;
  }
  return square <= error_m() * error_m();
}

void CoverByOwnCells(const std::vector<Point>& points, const CellGrid& grid, unsigned depth,
                     CoveredPoints* covered) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted;  // code, index
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

void CoverByMergedCells(const std::vector<Point>& points, const CellGrid& grid, unsigned depth,
                        CoveredPoints* covered) {
  OwnCells cells(points, grid, depth);
  cells.Merge();
  cells.List(depth, covered);
}

void CoverByFewCells(const std::vector<Point>& points, const CellGrid& grid, unsigned depth,
                     CoveredPoints* covered) {
  Choices choices(points, grid, depth);
  CellQueues queues(choices);
  struct Taken {
    std::uint64_t code;
    std::size_t first;  // index of its first point in `order`
    std::size_t end;
  };
  std::vector<Taken> taken;
  std::vector<std::uint32_t> order;
  order.reserve(points.size());
  for (std::uint32_t count = queues.most(); count > 0; --count) {
    while (!queues.empty(count)) {
      const std::uint32_t cell = queues.Pop(count);
      const std::uint32_t left = choices.left(cell);
      if (left > 0 && left < count) queues.Push(cell, left);
      if (left < count) continue;
      const std::size_t first = order.size();
      choices.Take(cell, &order);
      taken.push_back({choices.CodeOf(cell), first, order.size()});
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
