// SPDX-License-Identifier: LGPL-2.1-or-later
#include "rate/built_in_model.h"

#include "rate/adaptive_model.h"

namespace lidar::rate {

std::unique_ptr<SizeModel> MakeBuiltInModel(RateModel) {
  AdaptiveCoefficients c;
  c.fallback.step = {9.0, -0.32, -0.03, 0};
  c.fallback.min_x = -2;
  c.fallback.max_x = 5;
  c.fallback.returns = 0.95;
  c.fallback.intensity = {6.0, 0.6, -0.02};
  return std::make_unique<AdaptiveModel>(c);
}

}  // namespace lidar::rate
