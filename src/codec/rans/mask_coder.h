// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes which pixels have a return: four at a time, in the context of their neighbours.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "src/codec/azimuth_alignment.h"
#include "src/codec/rans/nibble_model.h"
#include "src/codec/rans/rans.h"

namespace lidar::codec {

/// Bytes of 0 or 1, beam by beam.
using Mask = std::vector<std::uint8_t>;

class MaskCoder {
 public:
  /// `mask` has alignment.beams() rows of `columns`.
  void Encode(const Mask& mask, const AzimuthAlignment& alignment, std::uint32_t columns,
              RansEncoder* encoder);
  /// Fills `mask`, which has its size. Returns false if the stream ends too early.
  bool Decode(const AzimuthAlignment& alignment, std::uint32_t columns, RansDecoder* decoder,
              Mask* mask);
  /// Pieces of RansEncoder that a mask takes.
  static std::size_t Pieces(std::uint32_t beams, std::uint32_t columns) {
    return std::size_t{beams} * Groups(columns);
  }
  static constexpr std::uint32_t kGroup = 4;  // pixels a symbol
  static std::uint32_t Groups(std::uint32_t columns) { return (columns + kGroup - 1) / kGroup; }
  static constexpr unsigned kContexts = 256;
  /// The models before the first pixel. The bits of a context from bit 0: the pixel above to the
  /// left, the four above, the one to their right, and the two to the left.
  static const std::array<NibbleModel, kContexts>& InitialModels();

 private:
  template <class CodeFour>
  void CodeRow(std::uint32_t beam, std::uint32_t columns, CodeFour&& code);
  void Reset(const AzimuthAlignment& alignment, std::uint32_t columns);

  std::array<NibbleModel, kContexts> models_;
  AlignedRow<std::uint8_t> above_;
  std::vector<std::uint8_t> row_;  // the coded row, with room to the next multiple of four
};

}  // namespace lidar::codec
