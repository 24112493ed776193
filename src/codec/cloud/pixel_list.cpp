// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/pixel_list.h"

#include <algorithm>
#include <limits>

namespace lidar::codec::cloud {
namespace {

/// A point on its beam.
struct Placed {
  std::uint32_t pixel;
  std::uint32_t range_mm;
  std::int32_t residual;
  std::uint32_t point;
};

/// What coordinates round off, as PointErrors::rounding_m has it.
double Rounding(double range_m) {
  return 4 * static_cast<double>(std::numeric_limits<float>::epsilon()) * range_m;
}

/// Whether a point comes back within the error, with its residual or without.
bool Fits(const Sighting& s, const Placed& p, double elevation_off, const PixelErrors& e,
          bool with_residual) {
  const double range_off = e.range_m + std::abs(1e-3 * p.range_mm - s.range_m);
  const double up = std::abs(elevation_off) * kRadians * s.range_m;
  // The range that comes back makes the class. Half of it counts, and what integers round off.
  const double back_mm = std::max(p.range_mm - 1e3 * e.range_m - 1, 1.0);
  const std::int32_t width = ResidualWidth(e.tangent_um, static_cast<std::uint32_t>(back_mm));
  const double units =
      with_residual ? 0.5 * width + 1 : std::abs(static_cast<double>(p.residual)) + 0.5;
  const double side = units * kRadians * s.rho_m;
  const double most = e.error_m + Rounding(s.range_m);
  return range_off * range_off + up * up + side * side <= most * most;
}

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
  image.first_column = first;
  if (image.size() > kMostPixels) return false;
  for (Placed& p : *placed) p.pixel = p.pixel / turn * image.columns + p.pixel % turn - first;
  image.ranges.assign(image.size(), 0);
  list->points.assign(image.size(), 0);
  list->residuals.assign(image.size(), 0);
  return true;
}

}  // namespace

bool FillPixels(const std::vector<Sighting>& points, const BeamTable& table,
                const PixelErrors& errors, double nearest_m, PixelList* list) {
  *list = {};
  const std::int32_t half_step =
      static_cast<std::int32_t>(std::uint64_t{kTurn} * BeamTable::kParts / table.turn / 2) + 1;
  std::vector<Placed> placed;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const Sighting& s = points[i];
    constexpr double kFarthest = 1e5;
    if (s.range_m < std::max(nearest_m, 1e-3) || s.range_m > kFarthest) {
      list->rest.push_back(i);
      continue;
    }
    const std::uint32_t beam = table.BeamOf(s.elevation);
    const std::uint32_t column = table.ColumnOf(beam, s.azimuth);
    const std::int32_t residual = Wrapped(s.azimuth - table.AzimuthOf(beam, column));
    const Placed p = {beam * table.columns() + column,
                      static_cast<std::uint32_t>(std::lround(1e3 * s.range_m)), residual, i};
    const double off = s.elevation - table.beams[beam].elevation;
    const bool fits = errors.tangent_um > 0
                          ? std::abs(residual) <= half_step && Fits(s, p, off, errors, true)
                          : Fits(s, p, off, errors, false);
    if (fits && p.range_mm > 0) {
      placed.push_back(p);
    } else {
      list->rest.push_back(i);
    }
  }
  if (!PlaceImage(table, &placed, list)) return false;
  RangeImage& image = list->image;
  std::stable_sort(placed.begin(), placed.end(),
                   [](const Placed& a, const Placed& b) { return a.pixel < b.pixel; });
  for (const Placed& p : placed) {
    if (image.ranges[p.pixel] == 0) {
      image.ranges[p.pixel] = p.range_mm;
      list->residuals[p.pixel] = p.residual;
      list->points[p.pixel] = p.point;
      ++list->returns;
      continue;
    }
    // It comes back in the direction of the pixel's first return.
    const Sighting& s = points[p.point];
    Placed there = p;
    const std::int32_t width = ResidualWidth(errors.tangent_um, image.ranges[p.pixel]);
    there.residual = errors.tangent_um > 0
                         ? std::abs(p.residual - list->residuals[p.pixel]) + (width + 1) / 2 + 1
                         : p.residual;
    const double off = s.elevation - table.beams[p.pixel / image.columns].elevation;
    if (Fits(s, there, off, errors, false)) {
      list->extras.push_back({p.pixel, p.range_mm, p.point});
    } else {
      list->rest.push_back(p.point);
    }
  }
  return true;
}

}  // namespace lidar::codec::cloud
