// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/pixel_list.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lidar::codec::cloud {
namespace {

/// The distance [m] of a decoded point from the original one: along the beam, upwards and sideways.
struct Distances {
  double along = 0;
  double up = 0;
  double side = 0;
};

/// Returns the error of rounding coordinates [m], as in PointErrors::rounding_m.
double Rounding(double range_m) {
  return 4 * static_cast<double>(std::numeric_limits<float>::epsilon()) * range_m;
}

bool Within(const Distances& off, double error_m, double range_m) {
  const double most = error_m + Rounding(range_m);
  return off.along * off.along + off.up * off.up + off.side * off.side <= most * most;
}

/// Checks whether points would be decoded to within the error.
class PixelCheck {
 public:
  PixelCheck(const PlacedCloud& cloud, const PixelErrors& errors)
      : points_(*cloud.points),
        placed_(*cloud.placed),
        table_(*cloud.table),
        errors_(errors),
        half_step_(table_.step() / 2 + 1) {}

  /// Returns true if `point`, as the first return of its pixel, is decoded to within the error.
  bool Fits(std::size_t point) const {
    const PlacedPoint& p = placed_[point];
    constexpr double kFarthest = 1e5;
    if (!(p.along_m >= 1e-3 && p.along_m < kFarthest)) return false;
    if (errors_.tangent_um > 0) {
      if (std::abs(p.residual) > half_step_) return false;
      return Fits(point, {HalfWidth(errors_.tangent_um, RangeMm(p)), OwnBend(p)});
    }
    return Fits(point, {std::abs(static_cast<double>(p.residual)) + 0.5, OwnBend(p)});
  }
  /// Returns true if `point`, as a further return, is decoded to within the error. It is decoded in
  /// the direction of the pixel's first return, which is `first`.
  bool FitsWith(std::size_t point, std::size_t first) const {
    const PlacedPoint& p = placed_[point];
    const PlacedPoint& other = placed_[first];
    const auto apart = [](std::int32_t a, std::int32_t b) {
      return std::abs(static_cast<double>(a) - b);
    };
    Angles off{std::abs(static_cast<double>(p.residual)) + 0.5, 0.5};
    if (errors_.tangent_um > 0)
      off.azimuth =
          apart(p.residual, other.residual) + HalfWidth(errors_.tangent_um, RangeMm(other));
    if (errors_.bend_um > 0)
      off.elevation = apart(p.bend, other.bend) + HalfWidth(errors_.bend_um, RangeMm(other));
    return Fits(point, off);
  }
  static std::uint32_t RangeMm(const PlacedPoint& p) {
    return static_cast<std::uint32_t>(1e3 * p.along_m + 0.5);
  }

 private:
  /// The largest errors of a decoded point's angles, in angle units.
  struct Angles {
    double azimuth;
    double elevation;
  };
  double OwnBend(const PlacedPoint& p) const {
    return errors_.bend_um > 0 ? HalfWidth(errors_.bend_um, RangeMm(p)) : 0.5;
  }
  bool Fits(std::size_t point, const Angles& angles) const {
    const PlacedPoint& p = placed_[point];
    const Sighting& s = points_[point];
    Distances off;
    off.along = errors_.range_m + std::abs(1e-3 * RangeMm(p) - p.along_m);
    const double above_m = errors_.bend_um > 0 ? 0 : std::abs(p.above_m);
    off.up = above_m + angles.elevation * kRadians * s.range_m;
    off.side = angles.azimuth * kRadians * s.rho_m + SideError(table_.beams[p.beam], s.rho_m);
    return Within(off, errors_.error_m, s.range_m);
  }
  /// Returns the largest error of a residual that is due to rounding. The width of a class of
  /// residuals depends on the decoded range, which may be shorter than the original range.
  double HalfWidth(std::uint32_t tangent_um, std::uint32_t range_mm) const {
    const double back_mm = std::max(range_mm - 1e3 * errors_.range_m - 1, 1.0);
    return 0.5 * ResidualWidth(tangent_um, static_cast<std::uint32_t>(back_mm)) + 1;
  }
  /// Returns the error [m] of SideAngle() that is due to the error of the decoded range.
  double SideError(const BeamTable::Beam& beam, double rho_m) const {
    if (beam.side_um == 0) return 0;
    const double off = errors_.range_m + 1e-3;
    return 1e-6 * std::abs(beam.side_um) * off / std::max(rho_m - off, 1e-3);
  }

  const std::vector<Sighting>& points_;
  const std::vector<PlacedPoint>& placed_;
  const BeamTable& table_;
  const PixelErrors& errors_;
  std::int32_t half_step_;
};

/// A point that fits a pixel.
struct FittingPoint {
  std::uint32_t point;
  std::uint32_t beam;
  std::uint32_t column;
  std::uint32_t range_mm;
};

/// The points that fit a pixel. This list is compact, so later passes need not read all placed
/// points again.
struct Fitting {
  std::vector<FittingPoint> points;
  std::uint32_t first_column = UINT32_MAX;
  std::uint32_t last_column = 0;
  std::size_t asked = 0;  // number of points at `nearest_m` or farther
};

Fitting FindFitting(const PlacedCloud& cloud, const PixelCheck& check, double nearest_m,
                    std::vector<std::uint32_t>* rest) {
  const std::vector<PlacedPoint>& placed = *cloud.placed;
  Fitting fitting;
  fitting.points.reserve(placed.size() / cloud.stride + 1);
  for (std::size_t i = 0; i < placed.size(); i += cloud.stride) {
    const auto point = static_cast<std::uint32_t>(i);
    const PlacedPoint& p = placed[i];
    const bool is_asked = (*cloud.points)[i].range_m >= nearest_m;
    fitting.asked += is_asked ? 1 : 0;
    const std::uint32_t range_mm = is_asked && check.Fits(i) ? PixelCheck::RangeMm(p) : 0;
    if (range_mm == 0) {
      rest->push_back(point);
      continue;
    }
    fitting.first_column = std::min(fitting.first_column, p.column);
    fitting.last_column = std::max(fitting.last_column, p.column);
    fitting.points.push_back({point, p.beam, p.column, range_mm});
  }
  return fitting;
}

/// Sets the size of the image. Its columns are those from the first column with a point to the last
/// one. Returns false if the image is too large.
bool PlaceImage(const BeamTable& table, const Fitting& fitting, const PixelErrors& errors,
                PixelList* list) {
  RangeImage& image = list->image;
  const bool is_empty = fitting.points.empty();
  image.beams = table.rows();
  image.columns = is_empty ? 1 : fitting.last_column - fitting.first_column + 1;
  image.first_column = is_empty ? 0 : fitting.first_column;
  if (image.size() > kMostPixels) return false;
  image.ranges.assign(image.size(), 0);
  list->points.assign(image.size(), 0);
  if (errors.tangent_um > 0) list->residuals.assign(image.size(), 0);
  if (errors.bend_um > 0) list->bends.assign(image.size(), 0);
  return true;
}

}  // namespace

void PixelList::DropFewExtras() {
  constexpr std::size_t kPixelsToAnExtra = 256;  // pixels for each further return
  if (extras.size() * kPixelsToAnExtra > returns) return;
  for (const ExtraReturn& extra : extras) rest.push_back(extra.point);
  extras.clear();
}

std::size_t CountFitting(const PlacedCloud& cloud, const PixelErrors& errors) {
  const PixelCheck check(cloud, errors);
  std::size_t count = 0;
  for (std::size_t i = 0; i < cloud.placed->size(); i += cloud.stride)
    if (check.Fits(i)) ++count;
  return count;
}

std::vector<std::uint32_t> FittingRanges(const PlacedCloud& cloud, const PixelErrors& errors) {
  const PixelCheck check(cloud, errors);
  std::vector<std::uint32_t> ranges;
  for (std::size_t i = 0; i < cloud.placed->size(); i += cloud.stride)
    if (check.Fits(i)) ranges.push_back(PixelCheck::RangeMm((*cloud.placed)[i]));
  return ranges;
}

bool FillPixels(const PlacedCloud& cloud, const PixelErrors& errors, double nearest_m,
                PixelList* list) {
  const std::vector<PlacedPoint>& placed = *cloud.placed;
  list->image.intensity.clear();
  list->extras.clear();
  list->rest.clear();
  list->returns = 0;
  const PixelCheck check(cloud, errors);
  const Fitting fitting = FindFitting(cloud, check, nearest_m, &list->rest);
  if (!PlaceImage(*cloud.table, fitting, errors, list)) return false;
  RangeImage& image = list->image;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> further;  // pixel, point
  for (const FittingPoint& p : fitting.points) {
    const std::uint32_t pixel = p.beam * image.columns + p.column - image.first_column;
    if (image.ranges[pixel] != 0) {
      further.emplace_back(pixel, p.point);
      continue;
    }
    image.ranges[pixel] = p.range_mm;
    if (errors.tangent_um > 0) list->residuals[pixel] = placed[p.point].residual;
    if (errors.bend_um > 0) list->bends[pixel] = placed[p.point].bend;
    list->points[pixel] = p.point;
  }
  list->returns = fitting.points.size() - further.size();
  list->asked = fitting.asked;
  std::sort(further.begin(), further.end());
  for (const auto& [pixel, point] : further) {
    if (check.FitsWith(point, list->points[pixel])) {
      list->extras.push_back({pixel, PixelCheck::RangeMm(placed[point]), point});
    } else {
      list->rest.push_back(point);
    }
  }
  return true;
}

}  // namespace lidar::codec::cloud
