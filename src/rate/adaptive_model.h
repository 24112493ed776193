// SPDX-License-Identifier: LGPL-2.1-or-later
// Our predictor. For each coding mode, it computes the logarithm of the size from the logarithm of
// the step. Each encoded slice corrects it.
#pragma once
#include <array>
#include <map>
#include <optional>
#include <string>

#include "src/rate/size_model.h"
#include "src/rate/slice_tracker.h"

namespace lidar::rate {

/// The coefficients of log2(bytes) for one coding mode. They are for x = log2(step / 1 cm) and n =
/// log2(returns / 1000).
struct ModeCoefficients {
  std::array<double, 4> step{};  // of a cubic in x, lowest power first
  double min_x = -3;             // the fit is a straight line outside of [min_x, max_x]
  double max_x = 5;
  double returns = 1;                 // factor of n
  std::array<double, 2> intensity{};  // of a line in log2(intensity bits)
  double intensity_returns = 1;       // factor of n for intensity

  double GeometryLog2(double x, double n) const;
  double IntensityLog2(double bits, double n) const;
  /// Returns true if the size falls as the step rises, over the whole range. Choose() requires
  /// this.
  bool Falls() const;
};

struct AdaptiveCoefficients {
  std::map<std::string, ModeCoefficients> modes;
  /// The coefficients for modes that are not in the file. The slices of such a mode correct them.
  ModeCoefficients fallback;
};

class AdaptiveModel : public SizeModel {
 public:
  explicit AdaptiveModel(AdaptiveCoefficients coefficients)
      : coefficients_(std::move(coefficients)) {}

  PredictedSize Predict(const SliceFeatures& slice, const Settings& settings) const override;
  Settings Choose(const SliceFeatures& slice, double bytes,
                  const SettingLimits& limits) const override;
  void OnEncoded(const SliceFeatures& slice, const Settings& settings,
                 const EncodedSize& encoded) override;

 private:
  struct Learned {
    SliceTracker geometry;
    SliceTracker intensity;
    /// How steeply the sizes of this scene fall as the step rises, relative to the fit.
    double slope = 1;
    double thinning = 0.8;                    // exponent of keep_fraction in the size
    std::optional<std::uint64_t> last_slice;  // scan and sector, to recognise a re-encoding
  };
  const ModeCoefficients& Mode(const std::string& mode) const;
  /// Returns what was learned about a mode, or null. If the last slice had another mode of the same
  /// geometry, returns what was learned about that mode, because the scene is the same.
  const Learned* LearnedOf(const std::string& mode) const;
  double GeometryLog2(const SliceFeatures& slice, double step_m) const;
  /// Estimates which part of a slice's bytes is intensity. An estimate is necessary because codecs
  /// report only the sum.
  double IntensityShare(const SliceFeatures& slice, double step_m, unsigned bits,
                        const PredictedSize& predicted) const;
  /// Updates `learned` by the observed log size. `again` is true if the model has already learned
  /// from an earlier encoding of this slice.
  void LearnGeometry(Learned* learned, const SliceFeatures& slice, double x, double observed,
                     bool again);
  void LearnIntensity(Learned* learned, const SliceFeatures& slice, double bits, double observed,
                      bool again);

  AdaptiveCoefficients coefficients_;
  std::map<std::string, Learned> learned_;
  std::string last_mode_;
};

}  // namespace lidar::rate
