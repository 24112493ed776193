// SPDX-License-Identifier: LGPL-2.1-or-later
#include "rate/size_model.h"

#include <algorithm>
#include <cmath>

namespace lidar::rate {

double ClampStep(double step_m, const SettingLimits& limits) {
  const double unit = limits.step_unit_m;
  const double coarsest = std::max(limits.coarsest_step_m, unit);
  const double step = std::clamp(step_m, std::min(limits.finest_step_m, coarsest), coarsest);
  if (unit <= 0) return step;
  // Nearest in the logarithm, because bytes go with the logarithm of the step.
  const double below = std::max(1.0, std::floor(step / unit + 1e-9));
  const double n = step * step > below * (below + 1) * unit * unit ? below + 1 : below;
  return n * unit > coarsest * (1 + 1e-9) ? below * unit : n * unit;
}

}  // namespace lidar::rate
