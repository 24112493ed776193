// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/pixel_list.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/codec/cloud/beam_locator.h"

namespace lidar::codec::cloud {
namespace {

/// A point on its beam.
struct Placed {
  std::uint32_t pixel;
  std::uint32_t range_mm;
  std::int32_t residual;
  std::uint32_t point;
};

/// How far a point is from its beam and column [m].
struct Distances {
  double along = 0;
  double up = 0;
  double side = 0;
};

/// What coordinates round off, as PointErrors::rounding_m has it.
double Rounding(double range_m) {
  return 4 * static_cast<double>(std::numeric_limits<float>::epsilon()) * range_m;
}

bool Within(const Distances& off, double error_m, double range_m) {
  const double most = error_m + Rounding(range_m);
  return off.along * off.along + off.up * off.up + off.side * off.side <= most * most;
}

/// Places points in the image of a table.
class Placer {
 public:
  Placer(const std::vector<Sighting>& points, const BeamTable& table, const PixelErrors& errors)
      : points_(points),
        table_(table),
        errors_(errors),
        locator_(table),
        finder_(table),
        half_step_(
            static_cast<std::int32_t>(std::uint64_t{kTurn} * BeamTable::kParts / table.turn / 2) +
            1) {}

  /// False where it fits no pixel.
  bool Place(std::uint32_t point, Placed* placed) const {
    const Sighting& s = points_[point];
    const BeamLocator::Found found = locator_.Find(s);
    constexpr double kFarthest = 1e5;
    if (!(found.along_m >= 1e-3 && found.along_m < kFarthest)) return false;
    const BeamTable::Beam& beam = table_.beams[found.beam];
    const std::int32_t azimuth = AzimuthBy(beam, s);
    const std::uint32_t column = finder_.ColumnOf(found.beam, azimuth);
    *placed = {found.beam * table_.columns() + column,
               static_cast<std::uint32_t>(std::lround(1e3 * found.along_m)),
               Wrapped(azimuth - table_.AzimuthOf(found.beam, column)), point};
    if (placed->range_mm == 0) return false;
    Distances off;
    off.along = errors_.range_m + std::abs(1e-3 * placed->range_mm - found.along_m);
    off.up = std::abs(found.above_m) + 0.5 * kRadians * s.range_m;
    double units = std::abs(static_cast<double>(placed->residual)) + 0.5;
    if (errors_.tangent_um > 0) {
      if (std::abs(placed->residual) > half_step_) return false;
      units = 0.5 * WidthAt(placed->range_mm) + 1;
    }
    off.side = units * kRadians * s.rho_m + SideError(beam, s.rho_m);
    return Within(off, errors_.error_m, s.range_m);
  }
  /// Whether a point comes back where the first return of its pixel is, at its own range.
  bool FitsDirection(const Placed& placed, std::int32_t residual, std::uint32_t range_mm) const {
    const Sighting& s = points_[placed.point];
    const std::uint32_t row = placed.pixel / table_.columns();
    const BeamLocator::Found found = locator_.On(row, s);
    Distances off;
    off.along = errors_.range_m + std::abs(1e-3 * placed.range_mm - found.along_m);
    off.up = std::abs(found.above_m) + 0.5 * kRadians * s.range_m;
    double units = std::abs(static_cast<double>(placed.residual)) + 0.5;
    if (errors_.tangent_um > 0)
      units =
          std::abs(static_cast<double>(placed.residual - residual)) + 0.5 * WidthAt(range_mm) + 1;
    off.side = units * kRadians * s.rho_m + SideError(table_.beams[row], s.rho_m);
    return Within(off, errors_.error_m, s.range_m);
  }

 private:
  static std::int32_t AzimuthBy(const BeamTable::Beam& beam, const Sighting& s) {
    if (beam.side_um == 0) return s.azimuth;
    const auto angle = static_cast<std::int32_t>(std::lround(SideAngle(beam, s.rho_m)));
    return (s.azimuth - angle) & (kTurn - 1);
  }
  /// The class of a residual is that of the range that comes back.
  double WidthAt(std::uint32_t range_mm) const {
    const double back_mm = std::max(range_mm - 1e3 * errors_.range_m - 1, 1.0);
    return ResidualWidth(errors_.tangent_um, static_cast<std::uint32_t>(back_mm));
  }
  /// What the range that comes back makes of the angle at which the beam passes the origin.
  double SideError(const BeamTable::Beam& beam, double rho_m) const {
    if (beam.side_um == 0) return 0;
    const double off = errors_.range_m + 1e-3;
    return 1e-6 * std::abs(beam.side_um) * off / std::max(rho_m - off, 1e-3);
  }

  const std::vector<Sighting>& points_;
  const BeamTable& table_;
  const PixelErrors& errors_;
  BeamLocator locator_;
  ColumnFinder finder_;
  std::int32_t half_step_;
};

/// The image has the columns that see something, and pixels become its own.
bool PlaceImage(const BeamTable& table, std::vector<Placed>* placed, PixelList* list) {
  const std::uint32_t turn = table.columns();
  std::uint32_t first = turn - 1;
  std::uint32_t last = 0;
  for (const Placed& p : *placed) {
    first = std::min(first, p.pixel % turn);
    last = std::max(last, p.pixel % turn);
  }
  RangeImage& image = list->image;
  image.beams = table.rows();
  image.columns = first <= last ? last - first + 1 : 1;
  image.first_column = first <= last ? first : 0;
  if (image.size() > kMostPixels) return false;
  image.ranges.assign(image.size(), 0);
  list->points.assign(image.size(), 0);
  list->residuals.assign(image.size(), 0);
  return true;
}

}  // namespace

bool FillPixels(const std::vector<Sighting>& points, const BeamTable& table,
                const PixelErrors& errors, double nearest_m, PixelList* list) {
  list->image = {};
  list->extras.clear();
  list->rest.clear();
  list->returns = 0;
  const Placer placer(points, table, errors);
  std::vector<Placed> placed;
  placed.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    Placed p{};
    if (points[i].range_m >= nearest_m && placer.Place(i, &p)) {
      placed.push_back(p);
    } else {
      list->rest.push_back(i);
    }
  }
  if (!PlaceImage(table, &placed, list)) return false;
  RangeImage& image = list->image;
  std::vector<Placed> further;
  const auto pixel_of = [&](const Placed& p) {
    return p.pixel / table.columns() * image.columns + p.pixel % table.columns() -
           image.first_column;
  };
  for (const Placed& p : placed) {
    const std::uint32_t pixel = pixel_of(p);
    if (image.ranges[pixel] != 0) {
      further.push_back(p);
      continue;
    }
    image.ranges[pixel] = p.range_mm;
    list->residuals[pixel] = p.residual;
    list->points[pixel] = p.point;
    ++list->returns;
  }
  std::stable_sort(further.begin(), further.end(),
                   [](const Placed& a, const Placed& b) { return a.pixel < b.pixel; });
  for (const Placed& p : further) {
    const std::uint32_t pixel = pixel_of(p);
    if (placer.FitsDirection(p, list->residuals[pixel], image.ranges[pixel])) {
      list->extras.push_back({pixel, p.range_mm, p.point});
    } else {
      list->rest.push_back(p.point);
    }
  }
  return true;
}

}  // namespace lidar::codec::cloud
