// SPDX-License-Identifier: LGPL-2.1-or-later
// The features of a slice, and the interface that predicts its encoded size.
#pragma once
#include <cstdint>
#include <string>

#include "src/base/units.h"

namespace lidar::rate {

/// The input of the predictors, for any codec.
struct SliceFeatures {
  std::uint32_t scan_id = 0;  // a new value starts a scan
  std::uint32_t slice_index = 0;
  std::uint32_t slice_count = 1;
  double scans_per_second = 10;
  std::uint32_t returns = 0;  // points that would be coded if none were thinned
  double extent_m = 0;        // longest side of the slice's box (xyz), or its longest range
  /// The coding mode of the slice: "xyz" or "range", a dash, and the codec's name for its coder
  /// ("range-adaptive", "xyz-kd6"). Each mode has its own coefficients and corrections.
  std::string mode;
};

struct Settings {
  double step_m = 0;            // step of the uniform grid
  unsigned intensity_bits = 0;  // 0: geometry only
  unsigned level = 0;           // compression level; only the paper's model chooses it
};

/// The limits within which a predictor chooses settings.
struct SettingLimits {
  double finest_step_m = 0.001;
  double coarsest_step_m = 0.04;
  double step_unit_m = 0;  // steps are finest_step_m plus multiples of this; 0: any step
  unsigned intensity_bits = 0;
  unsigned level = 0;
};

struct PredictedSize {
  double geometry_bytes = 0;
  double intensity_bytes = 0;
  double total() const { return geometry_bytes + intensity_bytes; }
};

/// An encoded slice, as the codec reports it.
struct EncodedSize {
  DataSize size;
  double step_m = 0;         // the step that was used
  double keep_fraction = 1;  // part of the returns that was left after thinning
};

/// Predicts the sizes of slices, and chooses settings by these predictions.
class SizeModel {
 public:
  virtual ~SizeModel() = default;
  /// Returns the predicted bytes of the slice if nothing is thinned.
  virtual PredictedSize Predict(const SliceFeatures& slice, const Settings& settings) const = 0;
  /// Returns the settings within `limits` whose predicted size is nearest to `bytes`.
  virtual Settings Choose(const SliceFeatures& slice, double bytes,
                          const SettingLimits& limits) const = 0;
  /// Learns from an encoded slice. A second call for the same slice means that it was encoded
  /// again.
  virtual void OnEncoded(const SliceFeatures& slice, const Settings& settings,
                         const EncodedSize& encoded) = 0;
};

/// The two allowed steps next to a wanted step: the nearest finer one and the nearest coarser one.
/// They are equal if the wanted step itself is allowed, or if only one side has an allowed step.
struct AllowedSteps {
  double finer_m = 0;
  double coarser_m = 0;
};
AllowedSteps StepsAround(double step_m, const SettingLimits& limits);
/// Returns the allowed step that is nearest to `step_m`.
double ClampStep(double step_m, const SettingLimits& limits);

}  // namespace lidar::rate
