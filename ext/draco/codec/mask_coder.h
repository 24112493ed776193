// SPDX-License-Identifier: LGPL-2.1-or-later
// Which pixels have a return: four at a time, in the context of their neighbours.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "draco/codec/azimuth_alignment.h"
#include "draco/codec/nibble_model.h"
#include "draco/codec/rans.h"

namespace lidar::codec {

/// Bytes of 0 or 1, beam by beam.
using Mask = std::vector<std::uint8_t>;

class MaskCoder {
 public:
  /// `mask` has alignment.beams() rows of `columns`.
  void Encode(const Mask& mask, const AzimuthAlignment& alignment, std::uint32_t columns,
              RansEncoder* encoder);
  /// Fills `mask`, which has that size already. Any stream gives some mask.
  void Decode(const AzimuthAlignment& alignment, std::uint32_t columns, RansDecoder* decoder,
              Mask* mask);

 private:
  template <class CodeFour>
  void ForEachFour(const AzimuthAlignment& alignment, std::uint32_t columns, CodeFour&& code);
  void Reset(const AzimuthAlignment& alignment, std::uint32_t columns);

  static constexpr unsigned kContexts = 256;
  std::array<NibbleModel, kContexts> models_;
  AlignedRow<std::uint8_t> above_;
};

}  // namespace lidar::codec
