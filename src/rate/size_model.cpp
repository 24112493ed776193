// SPDX-License-Identifier: LGPL-2.1-or-later
#include "rate/size_model.h"

#include <algorithm>
#include <cmath>

namespace lidar::rate {

double ClampStep(double step_m, const SettingLimits& limits) {
  const double finest = limits.finest_step_m;
  const double coarsest = std::max(limits.coarsest_step_m, finest);
  const double step = std::clamp(step_m, finest, coarsest);
  const double unit = limits.step_unit_m;
  if (unit <= 0) return step;
  constexpr double kRounding = 1e-9;  // 41 units of a millimetre are no exact double
  const double below = finest + std::floor((step - finest) / unit + kRounding) * unit;
  const double above = below + unit;
  // Nearest in the logarithm, because bytes go with the logarithm of the step.
  return step * step > below * above && above <= coarsest * (1 + kRounding) ? above : below;
}

}  // namespace lidar::rate
