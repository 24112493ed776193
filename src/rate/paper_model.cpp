// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/paper_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lidar::rate {

std::array<double, kPaperFeatures> PaperFeatures(double q, double c, double returns) {
  const double n = returns / 1000;  // keeps the least squares well conditioned
  return {q, c, n, q * q, q * c, q * n, c * c, c * n, n * n};
}

double PaperPolynomial::Bytes(double q, double c, double returns) const {
  const auto features = PaperFeatures(q, c, returns);
  double bytes = beta;
  for (std::size_t i = 0; i < kPaperFeatures; ++i) bytes += alpha[i] * features[i];
  return bytes;
}

double BitsOfStep(double extent_m, double step_m) {
  return std::log2(std::max(extent_m, 0.0) / step_m + 1);
}

double StepOfBits(double extent_m, double bits) { return extent_m / (std::exp2(bits) - 1); }

std::string GeometryOf(const std::string& mode) { return mode.substr(0, mode.find('-')); }

const PaperPolynomial& PaperModel::Polynomial(const std::string& mode) const {
  const auto found = coefficients_.geometries.find(GeometryOf(mode));
  if (found != coefficients_.geometries.end()) return found->second;
  static const PaperPolynomial kNone;
  return coefficients_.geometries.empty() ? kNone : coefficients_.geometries.begin()->second;
}

PredictedSize PaperModel::Predict(const SliceFeatures& slice, const Settings& settings) const {
  const double q = BitsOfStep(slice.extent_m, settings.step_m);
  // The polynomial may be negative far from its training data.
  return {std::max(0.0, Polynomial(slice.mode).Bytes(q, settings.level, slice.returns)), 0};
}

Settings PaperModel::Choose(const SliceFeatures& slice, double bytes,
                            const SettingLimits& limits) const {
  const PaperPolynomial& polynomial = Polynomial(slice.mode);
  const bool has_levels = GeometryOf(slice.mode) == "xyz";
  Settings best{ClampStep(limits.coarsest_step_m, limits), limits.intensity_bits, limits.level};
  if (!(slice.extent_m > 0)) return best;
  double least = std::numeric_limits<double>::infinity();
  for (int q = kMinBits; q <= kMaxBits; ++q) {
    const double step = StepOfBits(slice.extent_m, q);
    if (step > limits.coarsest_step_m || step < limits.finest_step_m) continue;
    for (unsigned c = 0; c <= (has_levels ? kMaxLevel : 0); ++c) {
      const unsigned level = has_levels ? c : limits.level;
      const double error = std::abs(polynomial.Bytes(q, level, slice.returns) - bytes);
      if (error >= least) continue;
      least = error;
      best = {ClampStep(step, limits), limits.intensity_bits, level};
    }
  }
  return best;
}

}  // namespace lidar::rate
