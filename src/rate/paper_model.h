// SPDX-License-Identifier: LGPL-2.1-or-later
// The predictor of the paper. It computes bytes by a polynomial of quantisation bits, compression
// level and number of points.
#pragma once
#include <array>
#include <map>
#include <string>

#include "src/rate/size_model.h"

namespace lidar::rate {

/// The features of a polynomial of second order in q, c and N / 1000: q, c, N, q q, q c, q N, c c,
/// c N, N N.
constexpr std::size_t kPaperFeatures = 9;
std::array<double, kPaperFeatures> PaperFeatures(double q, double c, double returns);

/// The polynomial r = alpha' Phi(q, c, N) + beta, in bytes. Phi are the PaperFeatures().
struct PaperPolynomial {
  std::array<double, kPaperFeatures> alpha{};
  double beta = 0;
  double Bytes(double q, double c, double returns) const;
};

struct PaperCoefficients {
  std::map<std::string, PaperPolynomial> geometries;  // by "xyz", "range"
};

/// BitsOfStep() and StepOfBits() convert between the step of a grid and the quantisation bits of a
/// box with sides of `extent_m`.
double BitsOfStep(double extent_m, double step_m);
double StepOfBits(double extent_m, double bits);
/// Returns the geometry of a mode: "xyz" for "xyz-kd6", for example.
std::string GeometryOf(const std::string& mode);

/// Predicts by a polynomial that was fitted once, as in the paper. It does not learn while it runs.
class PaperModel : public SizeModel {
 public:
  explicit PaperModel(PaperCoefficients coefficients) : coefficients_(std::move(coefficients)) {}

  /// The polynomial has no term for intensity bits. Its bytes therefore always include as many
  /// intensity bits as the polynomial was trained with.
  PredictedSize Predict(const SliceFeatures& slice, const Settings& settings) const override;
  /// Chooses q from 8 to 24, and for xyz also c from 0 to 9, so that |r - bytes| is smallest. Only
  /// steps within `limits` are considered.
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
