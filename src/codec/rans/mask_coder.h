// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes which pixels have a return. Four pixels are a symbol, coded in the context of their
// neighbours.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "src/codec/azimuth_alignment.h"
#include "src/codec/rans/nibble_model.h"
#include "src/codec/rans/rans.h"

namespace lidar::codec {

/// A byte for each pixel, beam by beam: 1 if the pixel has a return, else 0.
using Mask = std::vector<std::uint8_t>;

class MaskCoder {
 public:
  /// Encodes `mask`, which has alignment.beams() rows of `columns` pixels.
  void Encode(const Mask& mask, const AzimuthAlignment& alignment, std::uint32_t columns,
              RansEncoder* encoder);
  /// Fills `mask`. The caller has already given it its size. Returns false if the stream ends too
  /// early.
  bool Decode(const AzimuthAlignment& alignment, std::uint32_t columns, RansDecoder* decoder,
              Mask* mask);
  /// Returns the number of pieces that a mask adds to a RansEncoder.
  static std::size_t Pieces(std::uint32_t beams, std::uint32_t columns) {
    return std::size_t{beams} * Groups(columns);
  }
  static constexpr std::uint32_t kGroup = 4;  // pixels per symbol
  static std::uint32_t Groups(std::uint32_t columns) { return (columns + kGroup - 1) / kGroup; }
  static constexpr unsigned kContexts = 256;
  /// Returns the models before the first pixel. A context has these bits, from bit 0 on: the pixel
  /// above left of the group, the four pixels above the group, the pixel above right of it, and the
  /// last two pixels to the left of it.
  static const std::array<NibbleModel, kContexts>& InitialModels();

 private:
  template <class CodeFour>
  void CodeRow(std::uint32_t beam, std::uint32_t columns, CodeFour&& code);
  void Reset(const AzimuthAlignment& alignment, std::uint32_t columns);

  std::array<NibbleModel, kContexts> models_;
  AlignedRow<std::uint8_t> above_;
  std::vector<std::uint8_t> row_;  // the row being coded, padded to a multiple of four
};

}  // namespace lidar::codec
