// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/mixing/temporal_model.h"

namespace lidar::codec::mixing {

void TemporalModel::Reset() {
  counters.fill({});
  mask.fill({});
  recalled_spread.fill(2'048);
  spatial_spread.fill(4'096);
  constexpr std::int16_t kCounter = kWeightOne / 4;
  constexpr std::int16_t kRecalled = kWeightOne * 3 / 5;
  constexpr std::int16_t kSpatial = kWeightOne / 10;
  for (Weights& set : weights) {
    set.values.fill(0);
    for (unsigned i = 0; i < kTemporalContexts.size(); ++i) set.values[i] = kCounter;
    set.values[kTemporalContexts.size()] = kRecalled;
    set.values[kTemporalContexts.size() + 1] = kSpatial;
  }
  for (Weights& set : mask_weights) set.values.fill(kCounter);
}

}  // namespace lidar::codec::mixing
