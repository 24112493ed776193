// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes what an image of first returns leaves open: how far each azimuth is from its column, and
// the further returns of a pixel.
#pragma once
#include <cstdint>
#include <vector>

#include "src/codec/cloud/pixel_list.h"

namespace lidar::codec::cloud {

/// What the residual of a pixel is first compared with.
enum class ResidualGuess : std::uint8_t { kNone = 0, kColumn = 1, kLast = 2, kBeforeLast = 3 };
constexpr unsigned kResidualGuesses = 4;

/// What comes back of a pixel's azimuth.
struct ResidualSettings {
  std::uint32_t tangent_um = 0;
  ResidualGuess guess = ResidualGuess::kNone;
};

/// Codes the places of a table's columns; false for a damaged stream.
template <class Coder>
bool CodePlaces(BeamTable* table, Coder* coder);

/// Codes the residuals of all pixels that have a range in `image`, which are the ranges that come
/// back; `residuals` become those that come back. False for a damaged stream.
template <class Coder>
bool CodeResiduals(const RangeImage& image, const ResidualSettings& settings,
                   std::vector<std::int32_t>* residuals, Coder* coder);

/// A further return, by the bins of the image's grid.
struct ExtraBin {
  std::uint32_t pixel = 0;
  std::int32_t bin = 0;  // less that of the pixel's first return
  std::uint8_t level = 0;
};
struct ExtraSettings {
  unsigned level_bits = 0;
  bool by_four = true;    // neighbours, else by the two of encoders of before
  std::size_t limit = 0;  // further returns, at most
};
/// Codes the further returns of `bins`, the bins of all pixels (-1: no return). False for a damaged
/// stream.
template <class Coder>
bool CodeExtras(const std::vector<std::int32_t>& bins, std::uint32_t columns,
                const ExtraSettings& settings, std::vector<ExtraBin>* extras, Coder* coder);

}  // namespace lidar::codec::cloud
