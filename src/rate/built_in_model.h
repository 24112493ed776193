// SPDX-License-Identifier: LGPL-2.1-or-later
// The predictor that is there when no model file is loaded.
#pragma once
#include <memory>

#include "rate/size_model.h"

namespace lidar::rate {

enum class RateModel { kAdaptive, kPaper };

std::unique_ptr<SizeModel> MakeBuiltInModel(RateModel kind);

}  // namespace lidar::rate
