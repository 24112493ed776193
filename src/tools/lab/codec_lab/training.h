// SPDX-License-Identifier: LGPL-2.1-or-later
// Samples of real encodings at random settings, and how well models fitted to them predict.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "src/rate/model_fit.h"
#include "src/tools/lab/codec_lab/scan.h"

namespace lidar::tools {

struct SamplingOptions {
  // Random slices of each source. Each slice gives the adaptive model a sample in each mode.
  std::size_t samples = 200;
  std::vector<std::string> modes;
  double min_step_m = 0.001;
  double max_step_m = 0.5;
  std::vector<std::uint32_t> slices = {1, 8};
  unsigned intensity_bits = 5;  // at most for the adaptive model, always for the paper's
  std::uint64_t seed = 1;
};

/// Gets the share of the work that is done, 0 to 1.
using Progress = std::function<void(double)>;

/// Random slices at random steps (uniform in the logarithm), slice counts and intensity bits. Range
/// modes skip clouds without order.
std::vector<rate::Sample> TakeSamples(const std::vector<ScanSet>& sets,
                                      const SamplingOptions& options, const Progress& progress);
/// Samples as in the paper: random quantisation bits 8..24 and compression levels 0..9 for xyz
/// geometry; for range geometry, if `modes` has it, 8..24 bits of the longest range. Slices differ
/// in the number of points, because the model has terms for it.
std::vector<rate::Sample> TakePaperSamples(const std::vector<ScanSet>& sets,
                                           const SamplingOptions& options,
                                           const Progress& progress);

struct FitReport {
  std::string name;
  std::size_t samples = 0;
  rate::FitError fit;
  rate::FitError cross_validation;
};

/// Cross-validates: leaves out each source in turn, or each fifth of the samples of one source.
FitReport Report(
    const std::string& name, const std::vector<rate::Sample>& samples,
    const std::function<std::unique_ptr<rate::SizeModel>(const std::vector<rate::Sample>&)>& fit);

}  // namespace lidar::tools
