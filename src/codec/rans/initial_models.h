// SPDX-License-Identifier: LGPL-2.1-or-later
// The states that the adaptive models have before the first return of a block.
#pragma once
#include <array>

#include "src/codec/rans/nibble_model.h"
#include "src/codec/rans/predictor.h"

namespace lidar::codec {

struct InitialModels {
  std::array<NibbleModel, kContexts> residuals;
  NibbleModel longs;
};

const InitialModels& InitialModelsOfValues();
const InitialModels& InitialModelsOfLevels();

}  // namespace lidar::codec
