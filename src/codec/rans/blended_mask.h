// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes which pixels have a return. Four pixels are a symbol, which is predicted by a blend of the
// models of four contexts.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "src/codec/azimuth_alignment.h"
#include "src/codec/rans/mask_coder.h"
#include "src/codec/rans/nibble_model.h"
#include "src/codec/rans/rans.h"

namespace lidar::codec {

/// Does the same as MaskCoder, in fewer bits and more time.
class BlendedMask {
 public:
  void Encode(const Mask& mask, const AzimuthAlignment& alignment, std::uint32_t columns,
              RansEncoder* encoder);
  bool Decode(const AzimuthAlignment& alignment, std::uint32_t columns, RansDecoder* decoder,
              Mask* mask);

 private:
  static constexpr std::uint32_t kGroup = MaskCoder::kGroup;
  static constexpr unsigned kBlended = std::tuple_size_v<BlendedModels>;
  /// The number of contexts of each kind.
  static constexpr std::array<std::uint32_t, kBlended> kSizes = {MaskCoder::kContexts, 2'048, 4'050,
                                                                 1'728};

  void Reset(const AzimuthAlignment& alignment, std::uint32_t columns);
  BlendedModels ModelsOf(const std::uint8_t* above, std::uint32_t before);
  BlendedModels EmptyModels();
  template <class CodeFour, class CodeEmpty>
  void CodeRow(std::uint32_t beam, std::uint32_t columns, CodeFour&& code, CodeEmpty&& code_empty);

  std::array<std::vector<NibbleModel>, kBlended> models_;
  /// For each azimuth, a bit per beam above: 1 if the beam has a return. Bit 0 is the nearest beam.
  AlignedRow<std::uint8_t> above_;
  std::vector<std::uint8_t> row_;  // the row being coded, padded to a multiple of four
};

}  // namespace lidar::codec
