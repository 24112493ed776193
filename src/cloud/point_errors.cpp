// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cloud/point_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/cloud/nearest_point.h"
#include "src/cloud/point_math.h"

namespace lidar {
namespace {

double Distance(const float* a, const float* b) { return std::sqrt(SquaredDistance(a, b)); }

/// Collects distances and computes their statistics.
class Distances {
 public:
  void Add(double metres) {
    ++errors_.points;
    sum_ += metres;
    errors_.max_m = std::max(errors_.max_m, metres);
  }
  /// Adds the distance from a decoded point to the nearest raw point. It counts only for the
  /// maximum.
  void AddBack(double metres) { errors_.max_m = std::max(errors_.max_m, metres); }
  void AddMissing(std::uint64_t points) { errors_.missing += points; }
  void OnCoordinate(double metres) { largest_ = std::max(largest_, std::abs(metres)); }
  /// Returns the statistics. The rounding error allows for three rounded coordinates of both
  /// points.
  PointErrors Take() {
    if (errors_.points > 0) errors_.mean_m = sum_ / static_cast<double>(errors_.points);
    errors_.rounding_m = 4 * static_cast<double>(std::numeric_limits<float>::epsilon()) * largest_;
    return errors_;
  }

 private:
  PointErrors errors_;
  double sum_ = 0;
  double largest_ = 0;
};

bool IsPresent(const DecodedPoint& p) { return p.range_mm > 0 || IsReturn(p.position); }

std::optional<PointErrors> ComparePixels(ByteView raw, const PointFields& fields,
                                         std::uint32_t point_step,
                                         const std::vector<DecodedPoint>& decoded) {
  const bool has_xyz = fields.HasPackedXyz();
  const bool has_range = fields.Has("range", FieldType::kU32);
  if (decoded.size() != raw.size / point_step || !(has_xyz || has_range)) return std::nullopt;
  const std::size_t range_offset = has_range ? fields.Find("range")->offset : 0;
  const std::size_t xyz_offset = has_xyz ? fields.Find("x")->offset : 0;
  const std::uint8_t* before = raw.data;
  Distances distances;
  for (const DecodedPoint& after : decoded) {
    const auto p = has_xyz ? PositionAt(before + xyz_offset) : std::array<float, 3>{};
    const std::uint32_t range = has_range ? RangeAt(before + range_offset) : 0;
    before += point_step;
    const bool was_present = has_range ? range > 0 : IsReturn(p);
    if (was_present != IsPresent(after)) distances.AddMissing(1);
    if (!was_present || !IsPresent(after)) continue;
    distances.OnCoordinate(1e-3 * after.range_mm);
    for (const float c : after.position) distances.OnCoordinate(static_cast<double>(c));
    if (!has_xyz) {
      distances.Add(1e-3 * std::abs(static_cast<double>(range) - after.range_mm));
    } else if (IsFinite(p)) {
      distances.Add(Distance(p.data(), after.position.data()));
    }
  }
  return distances.Take();
}

std::vector<float> ReturnsOf(ByteView raw, const PointFields& fields, std::uint32_t point_step) {
  const std::size_t offset = fields.Find("x")->offset;
  std::vector<float> returns;
  for (std::size_t at = 0; at + point_step <= raw.size; at += point_step) {
    const auto p = PositionAt(raw.data + at + offset);
    if (IsReturn(p)) returns.insert(returns.end(), p.begin(), p.end());
  }
  return returns;
}

/// Compares raw points with decoded points. If `may_merge` is true, a decoded point may represent
/// several raw points.
PointErrors CompareClouds(const std::vector<float>& before, const std::vector<float>& after,
                          bool in_order, bool may_merge) {
  Distances distances;
  for (const float coordinate : before) distances.OnCoordinate(static_cast<double>(coordinate));
  const std::size_t fewer = (before.size() - std::min(before.size(), after.size())) / 3;
  const std::size_t missing = may_merge && !after.empty() ? 0 : fewer;
  distances.AddMissing(missing);
  if (in_order && before.size() == after.size()) {
    for (std::size_t i = 0; i < before.size(); i += 3)
      distances.Add(Distance(&before[i], &after[i]));
    return distances.Take();
  }
  const NearestPoint original(before);
  for (std::size_t i = 0; i < after.size(); i += 3) {
    const double distance = original.DistanceFrom(&after[i]);
    // If points were removed, only the distances from decoded points to raw points are used.
    missing > 0 ? distances.Add(distance) : distances.AddBack(distance);
  }
  if (missing > 0) return distances.Take();
  const NearestPoint decoded(after);
  for (std::size_t i = 0; i < before.size(); i += 3)
    distances.Add(decoded.DistanceFrom(&before[i]));
  return distances.Take();
}

}  // namespace

std::optional<PointErrors> MeasureErrors(ByteView raw, const PointFields& fields,
                                         std::uint32_t point_step,
                                         const std::vector<DecodedPoint>& decoded, PointOrder order,
                                         bool thinned) {
  if (order == PointOrder::kPixels) return ComparePixels(raw, fields, point_step, decoded);
  if (!fields.HasPackedXyz()) return std::nullopt;
  std::vector<float> after;
  after.reserve(3 * decoded.size());
  for (const DecodedPoint& p : decoded)
    after.insert(after.end(), p.position.begin(), p.position.end());
  return CompareClouds(ReturnsOf(raw, fields, point_step), after, order == PointOrder::kKept,
                       order == PointOrder::kAny && !thinned);
}

}  // namespace lidar
