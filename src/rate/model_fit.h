// SPDX-License-Identifier: LGPL-2.1-or-later
// Least squares for the predictors: converts samples of real encodings to coefficients.
#pragma once
#include <optional>
#include <vector>

#include "src/rate/adaptive_model.h"
#include "src/rate/paper_model.h"

namespace lidar::rate {

/// A slice, encoded once.
struct Sample {
  SliceFeatures slice;
  Settings settings;
  double geometry_bytes = 0;
  double intensity_bytes = 0;
  unsigned source = 0;  // capture or scene: cross-validation leaves out whole sources
};

/// Fits a cubic for each mode. Returns nothing if a mode has fewer than kMinSamples or its sizes do
/// not fall with the step.
std::optional<AdaptiveCoefficients> FitAdaptive(const std::vector<Sample>& samples);
/// The paper's regression. Returns nothing with fewer than kMinSamples.
std::optional<PaperCoefficients> FitPaper(const std::vector<Sample>& samples);

struct FitError {
  double mean = 0;  // of |predicted / real - 1|
  double percentile_95 = 0;
};
/// The errors of predictions without any correction.
FitError ErrorOf(const SizeModel& model, const std::vector<Sample>& samples);

constexpr std::size_t kMinSamples = 20;

}  // namespace lidar::rate
