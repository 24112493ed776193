// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/size_model.h"

#include <algorithm>
#include <cmath>

namespace lidar::rate {

AllowedSteps StepsAround(double step_m, const SettingLimits& limits) {
  const double finest = limits.finest_step_m;
  const double coarsest = std::max(limits.coarsest_step_m, finest);
  const double step = std::clamp(step_m, finest, coarsest);
  const double unit = limits.step_unit_m;
  if (unit <= 0) return {step, step};
  constexpr double kRounding = 1e-9;  // for example, 41 mm is not an exact double
  const double finer = finest + std::floor((step - finest) / unit + kRounding) * unit;
  const double coarser = finer + unit;
  const bool exact = step - finer < kRounding;
  return {finer, exact || coarser > coarsest * (1 + kRounding) ? finer : coarser};
}

double ClampStep(double step_m, const SettingLimits& limits) {
  const AllowedSteps steps = StepsAround(step_m, limits);
  // The logarithms of steps are compared, because the number of bytes depends on the logarithm of
  // the step.
  return step_m * step_m > steps.finer_m * steps.coarser_m ? steps.coarser_m : steps.finer_m;
}

}  // namespace lidar::rate
