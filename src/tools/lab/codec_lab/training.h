// SPDX-License-Identifier: LGPL-2.1-or-later
// Takes samples of encodings at random settings. Measures how well models that are fitted to the
// samples predict sizes.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "src/rate/model_fit.h"
#include "src/tools/lab/codec_lab/scan.h"

namespace lidar::tools {

struct SamplingOptions {
  // The number of random slices of each source. The adaptive model gets one sample for each of
  // these slices and each mode.
  std::size_t samples = 200;
  std::vector<std::string> modes;
  double min_step_m = 0.001;
  double max_step_m = 0.5;
  std::vector<std::uint32_t> slices = {1, 8};
  // The adaptive model gets samples with 0 bits up to this number. The paper's model always gets
  // samples with this number.
  unsigned intensity_bits = 5;
  std::uint64_t seed = 1;
};

/// A function that is called with the share of the work that is done, from 0 to 1.
using Progress = std::function<void(double)>;

/// Encodes random slices with random steps, intensity bits and numbers of slices per scan. The
/// steps are uniform in the logarithm. Modes with range geometry skip clouds that are not
/// organised.
std::vector<rate::Sample> TakeSamples(const std::vector<ScanSet>& sets,
                                      const SamplingOptions& options, const Progress& progress);
/// Takes samples as in the paper. For xyz geometry, the quantisation bits are random from 8 to 24,
/// and the compression levels from 0 to 9. For range geometry, if `modes` contains it, the bits
/// divide the longest range, and are random from 8 up to those of the finest step. The slices have
/// different numbers of points, because the model has terms for this number.
std::vector<rate::Sample> TakePaperSamples(const std::vector<ScanSet>& sets,
                                           const SamplingOptions& options,
                                           const Progress& progress);

struct FitReport {
  std::string name;
  std::size_t samples = 0;
  rate::FitError fit;
  rate::FitError cross_validation;
};

/// Fits a model to the samples, and cross-validates the fit. For this, leaves out each source in
/// turn. If there is only one source, leaves out each fifth of its samples in turn.
FitReport Report(
    const std::string& name, const std::vector<rate::Sample>& samples,
    const std::function<std::unique_ptr<rate::SizeModel>(const std::vector<rate::Sample>&)>& fit);

}  // namespace lidar::tools
