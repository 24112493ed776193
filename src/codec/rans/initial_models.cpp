// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/rans/initial_models.h"

namespace lidar::codec {
namespace {

using Counts = std::array<std::uint16_t, kNibbles>;

#include "src/codec/rans/initial_counts.inc"

std::array<NibbleModel, kContexts> ModelsOf(const std::array<Counts, kContexts>& counts) {
  std::array<NibbleModel, kContexts> models;
  for (std::size_t i = 0; i < counts.size(); ++i) models[i] = NibbleModel(counts[i]);
  return models;
}

}  // namespace

const InitialModels& InitialModelsOfValues() {
  static const InitialModels models{ModelsOf(kValues), NibbleModel(kLongValues)};
  return models;
}

const InitialModels& InitialModelsOfLevels() {
  static const InitialModels models{ModelsOf(kLevels), NibbleModel(kLongLevels)};
  return models;
}

}  // namespace lidar::codec
