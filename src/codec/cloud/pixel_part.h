// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes what an image of first returns does not contain: the distances of azimuths from their
// columns, and the further returns of pixels.
#pragma once
#include <cstdint>
#include <vector>

#include "src/codec/cloud/pixel_list.h"

namespace lidar::codec::cloud {

/// How a pixel's residual is guessed: as 0, as the last residual of the column, or as the last or
/// the last but one of the row.
enum class ResidualGuess : std::uint8_t { kNone = 0, kColumn = 1, kLast = 2, kBeforeLast = 3 };
constexpr unsigned kResidualGuesses = 4;

/// How residuals of azimuths or elevations are coded.
struct ResidualSettings {
  std::uint32_t tangent_um = 0;
  ResidualGuess guess = ResidualGuess::kNone;
};

/// Codes the places of a table's columns. Returns false if the stream is damaged.
template <class Coder>
bool CodePlaces(BeamTable* table, Coder* coder);

/// Codes the curves of a table's path. Returns false if the stream is damaged.
template <class Coder>
bool CodePath(std::vector<PathBeam>* path, Coder* coder);

/// Codes the residuals of all pixels that have a range in `image`. The ranges must be the decoded
/// ones. Sets `residuals` to what a decoder gets. Returns false if the stream is damaged.
template <class Coder>
bool CodeResiduals(const RangeImage& image, const ResidualSettings& settings,
                   std::vector<std::int32_t>* residuals, Coder* coder);

/// A return of a pixel that already has a first return. `bin` is its range in the image's grid.
struct ExtraBin {
  std::uint32_t pixel = 0;
  std::int32_t bin = 0;  // bin minus the bin of the first return
  std::uint8_t level = 0;
};
struct ExtraSettings {
  unsigned level_bits = 0;
  bool by_four = true;    // context of four neighbours; false: of two, as in earlier encoders
  std::size_t limit = 0;  // largest number of further returns
};
/// Codes the further returns of pixels. `bins` has the bin of each pixel's first return, or -1 if
/// the pixel has no return. Returns false if the stream is damaged.
template <class Coder>
bool CodeExtras(const std::vector<std::int32_t>& bins, std::uint32_t columns,
                const ExtraSettings& settings, std::vector<ExtraBin>* extras, Coder* coder);

}  // namespace lidar::codec::cloud
