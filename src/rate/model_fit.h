// SPDX-License-Identifier: LGPL-2.1-or-later
// Fits the coefficients of the predictors to samples of real encodings, by least squares.
#pragma once
#include <optional>
#include <vector>

#include "src/rate/adaptive_model.h"
#include "src/rate/paper_model.h"

namespace lidar::rate {

/// A slice that was encoded once.
struct Sample {
  SliceFeatures slice;
  Settings settings;
  double geometry_bytes = 0;
  double intensity_bytes = 0;
  unsigned source = 0;  // capture or scene; cross-validation leaves out whole sources
};

/// Fits a cubic for each mode. Returns nothing if a mode has fewer than kMinSamples samples, or if
/// its sizes do not fall as the step rises.
std::optional<AdaptiveCoefficients> FitAdaptive(const std::vector<Sample>& samples);
/// Does the regression of the paper. Returns nothing if there are fewer than kMinSamples samples
/// for a geometry.
std::optional<PaperCoefficients> FitPaper(const std::vector<Sample>& samples);

struct FitError {
  double mean = 0;  // of |predicted / real - 1|
  double percentile_95 = 0;
};
/// Returns the errors of a model's predictions, without any correction.
FitError ErrorOf(const SizeModel& model, const std::vector<Sample>& samples);

constexpr std::size_t kMinSamples = 20;

}  // namespace lidar::rate
