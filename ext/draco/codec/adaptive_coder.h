// SPDX-License-Identifier: LGPL-2.1-or-later
// Our own coders of a block's integers: prediction, then adaptive rANS or a list for Draco.
#pragma once
#include <cstdint>
#include <vector>

#include "draco/codec/draco_integers.h"
#include "draco/codec/predictor.h"
#include "draco/codec/residual_model.h"

namespace lidar::codec {

/// Where the returns of a block are.
struct BlockShape {
  const AzimuthAlignment& alignment;
  const Mask& mask;
  std::uint32_t columns;
};

class AdaptiveCoder {
 public:
  /// Values are below kMaxBins.
  void Encode(const BlockShape& shape, const IntegerLists& lists, RansEncoder* encoder);
  /// Fills `lists` with a value, and a level where `has_levels`, for each return. False where the
  /// stream cannot be one of Encode().
  bool Decode(const BlockShape& shape, bool has_levels, RansDecoder* decoder, IntegerLists* lists);

  /// Residuals of values and levels in place of them, and back.
  void ToResiduals(const BlockShape& shape, IntegerLists* lists);
  bool FromResiduals(const BlockShape& shape, IntegerLists* lists);

  static constexpr std::uint32_t kMaxBins = 1U << 28;

 private:
  template <bool kLevels, class CodeValue, class CodeLevel>
  bool ForEachReturn(const BlockShape& shape, CodeValue&& code_value, CodeLevel&& code_level);
  void ResetModels();

  Neighbourhood values_;
  Neighbourhood levels_;
  ResidualModel value_model_;
  ResidualModel level_model_;
};

}  // namespace lidar::codec
