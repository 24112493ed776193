// SPDX-License-Identifier: LGPL-2.1-or-later
// The predictor of the paper: bytes as a polynomial of quantisation bits, level and points.
#pragma once
#include <array>
#include <map>
#include <string>

#include "src/rate/size_model.h"

namespace lidar::rate {

/// Second order in q, c and N / 1000: q, c, N, q q, q c, q N, c c, c N, N N.
constexpr std::size_t kPaperFeatures = 9;
std::array<double, kPaperFeatures> PaperFeatures(double q, double c, double returns);

/// r = alpha' Phi(q, c, N) + beta, in bytes.
struct PaperPolynomial {
  std::array<double, kPaperFeatures> alpha{};
  double beta = 0;
  double Bytes(double q, double c, double returns) const;
};

struct PaperCoefficients {
  std::map<std::string, PaperPolynomial> geometries;  // by "xyz", "range"
};

/// Converts between the step of a grid and quantisation bits of a box of `extent_m`.
double BitsOfStep(double extent_m, double step_m);
double StepOfBits(double extent_m, double bits);
/// "xyz" or "range", of a mode such as "xyz-kd6".
std::string GeometryOf(const std::string& mode);

/// Does not learn while it runs: as in the paper, the polynomial is fitted once.
class PaperModel : public SizeModel {
 public:
  explicit PaperModel(PaperCoefficients coefficients) : coefficients_(std::move(coefficients)) {}

  /// The polynomial has no term for intensity bits, so the bytes always include the intensity bits
  /// of its training.
  PredictedSize Predict(const SliceFeatures& slice, const Settings& settings) const override;
  /// argmin |r - bytes| over q = 8..24 and, for xyz, c = 0..9, within the limits of the step.
  Settings Choose(const SliceFeatures& slice, double bytes,
                  const SettingLimits& limits) const override;
  void OnEncoded(const SliceFeatures&, const Settings&, const EncodedSize&) override {}

  static constexpr int kMinBits = 8;
  static constexpr int kMaxBits = 24;
  static constexpr unsigned kMaxLevel = 9;

 private:
  const PaperPolynomial& Polynomial(const std::string& mode) const;
  PaperCoefficients coefficients_;
};

}  // namespace lidar::rate
