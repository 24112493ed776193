// SPDX-License-Identifier: LGPL-2.1-or-later
// Assigns points to the pixels of a sensor's image, and lists the points that fit no pixel.
#pragma once
#include <cstdint>
#include <vector>

#include "src/codec/cloud/beam_keeper.h"
#include "src/codec/cloud/beam_table.h"
#include "src/codec/range_image.h"

namespace lidar::codec::cloud {

/// A second or later return of a pixel.
struct ExtraReturn {
  std::uint32_t pixel = 0;  // ascending
  std::uint32_t range_mm = 0;
  std::uint32_t point = 0;  // index of the point
};

/// The largest errors that pixels may have.
struct PixelErrors {
  double error_m = 0;            // of the whole point
  double range_m = 0;            // of ranges
  std::uint32_t tangent_um = 0;  // of azimuths; 0: a pixel has the azimuth of its column
  std::uint32_t bend_um = 0;     // of elevations; 0: beams do not bend
};

struct PixelList {
  RangeImage image;
  std::vector<std::uint32_t> points;    // index of each pixel's first return
  std::vector<std::int32_t> residuals;  // residual of each pixel's azimuth
  std::vector<std::int32_t> bends;      // residual of each pixel's elevation
  std::vector<ExtraReturn> extras;
  std::vector<std::uint32_t> rest;  // indices of all other points
  std::size_t returns = 0;          // number of pixels with a return
  std::size_t asked = 0;            // number of points that are not too near for a pixel

  /// Moves the further returns to `rest` if there are very few of them. As `extras` they would need
  /// a flag for each pixel, which would cost more bits.
  void DropFewExtras();
};

/// Returns the width of a class of residuals, in angle units. With this width, no azimuth is off by
/// more than `tangent_um` at `range_mm`.
inline std::int32_t ResidualWidth(std::uint32_t tangent_um, std::uint32_t range_mm) {
  // The factor is 2 * 2^22 / (2000 pi).
  const std::uint64_t far_um = std::uint64_t{tangent_um} * 1'335;
  const std::uint32_t away_mm = range_mm == 0 ? 1 : range_mm;
  // A division of 32-bit numbers is faster.
  const std::uint64_t width =
      far_um <= UINT32_MAX ? static_cast<std::uint32_t>(far_um) / away_mm : far_um / away_mm;
  return static_cast<std::int32_t>(width < 1 ? 1 : width > kTurn ? kTurn : width);
}

/// The largest number of pixels in an image.
constexpr std::size_t kMostPixels = 1U << 20;

/// The points of a cloud, each with its pixel in a table of beams.
struct PlacedCloud {
  const std::vector<Sighting>* points;
  const std::vector<PlacedPoint>* placed;
  const BeamTable* table;
  std::size_t stride = 1;  // only every `stride`-th point is used
};

/// Returns the number of points that fit a pixel.
std::size_t CountFitting(const PlacedCloud& cloud, const PixelErrors& errors);
/// Returns the ranges of the points that fit a pixel [mm].
std::vector<std::uint32_t> FittingRanges(const PlacedCloud& cloud, const PixelErrors& errors);
/// Fills `list`. Points that are nearer than `nearest_m` go to `list->rest`. Returns false if the
/// image is too large.
bool FillPixels(const PlacedCloud& cloud, const PixelErrors& errors, double nearest_m,
                PixelList* list);

}  // namespace lidar::codec::cloud
