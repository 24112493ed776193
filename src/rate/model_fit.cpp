// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/model_fit.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>

namespace lidar::rate {
namespace {

constexpr double kUnitStep = 0.01;
constexpr Eigen::Index kMaxDegree = 3;

using Samples = std::vector<const Sample*>;

double X(const Sample& s) { return std::log2(s.settings.step_m / kUnitStep); }
double N(const Sample& s) { return std::log2(s.slice.returns / 1000.0); }

/// Returns the c that minimises |A c - b|. A feature that depends linearly on other features gets
/// no coefficient.
Eigen::VectorXd LeastSquares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  return a.colPivHouseholderQr().solve(b);
}

/// Returns the spread of the numbers of returns, in doublings. If the spread is small, the exponent
/// of the returns cannot be determined.
double ReturnsSpread(const Samples& samples) {
  const auto [low, high] = std::minmax_element(
      samples.begin(), samples.end(),
      [](const Sample* a, const Sample* b) { return a->slice.returns < b->slice.returns; });
  return N(**high) - N(**low);
}

void FitGeometry(const Samples& samples, Eigen::Index degree, ModeCoefficients* mode) {
  constexpr double kEnoughSpread = 0.5;  // doublings
  const auto rows = static_cast<Eigen::Index>(samples.size());
  const bool fit_returns = ReturnsSpread(samples) > kEnoughSpread;
  Eigen::MatrixXd a(rows, degree + 1 + (fit_returns ? 1 : 0));
  Eigen::VectorXd b(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Sample& s = *samples[static_cast<std::size_t>(i)];
    for (Eigen::Index k = 0; k <= degree; ++k) a(i, k) = std::pow(X(s), static_cast<double>(k));
    b(i) = std::log2(s.geometry_bytes) - (fit_returns ? 0 : N(s));
    if (fit_returns) a(i, degree + 1) = N(s);
  }
  const Eigen::VectorXd c = LeastSquares(a, b);
  mode->step = {};
  for (Eigen::Index k = 0; k <= degree; ++k) mode->step[static_cast<std::size_t>(k)] = c(k);
  mode->returns = fit_returns ? c(degree + 1) : 1;
}

void FitIntensity(const Samples& all, ModeCoefficients* mode) {
  Samples samples;
  std::copy_if(all.begin(), all.end(), std::back_inserter(samples), [](const Sample* s) {
    return s->settings.intensity_bits > 0 && s->intensity_bytes > 1;
  });
  // The model without samples: half a bit for each return and intensity bit. The first slice
  // corrects it.
  mode->intensity = {std::log2(1000 / 16.0), 1};
  mode->intensity_returns = 1;
  if (samples.size() < kMinSamples) return;
  const auto rows = static_cast<Eigen::Index>(samples.size());
  Eigen::MatrixXd a(rows, 2);
  Eigen::VectorXd b(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Sample& s = *samples[static_cast<std::size_t>(i)];
    a.row(i) << 1, std::log2(static_cast<double>(s.settings.intensity_bits));
    b(i) = std::log2(s.intensity_bytes) - N(s);
  }
  const Eigen::VectorXd c = LeastSquares(a, b);
  if (c(1) >= 0) mode->intensity = {c(0), c(1)};
}

std::optional<ModeCoefficients> FitMode(const Samples& samples) {
  if (samples.size() < kMinSamples) return std::nullopt;
  ModeCoefficients mode;
  const auto [finest, coarsest] =
      std::minmax_element(samples.begin(), samples.end(),
                          [](const Sample* a, const Sample* b) { return X(*a) < X(*b); });
  mode.min_x = X(**finest);
  mode.max_x = X(**coarsest);
  if (!(mode.min_x < mode.max_x)) return std::nullopt;
  FitIntensity(samples, &mode);
  for (Eigen::Index degree = kMaxDegree; degree >= 1; --degree) {
    FitGeometry(samples, degree, &mode);
    if (mode.Falls()) return mode;
  }
  return std::nullopt;
}

}  // namespace

std::optional<AdaptiveCoefficients> FitAdaptive(const std::vector<Sample>& samples) {
  std::map<std::string, Samples> by_mode;
  for (const Sample& s : samples)
    if (s.slice.returns > 0 && s.geometry_bytes > 0) by_mode[s.slice.mode].push_back(&s);
  AdaptiveCoefficients coefficients;
  std::size_t most = 0;
  for (const auto& [name, of_mode] : by_mode) {
    const auto mode = FitMode(of_mode);
    if (!mode) return std::nullopt;
    coefficients.modes[name] = *mode;
    if (of_mode.size() > most) coefficients.fallback = *mode;
    most = std::max(most, of_mode.size());
  }
  if (coefficients.modes.empty()) return std::nullopt;
  return coefficients;
}

std::optional<PaperCoefficients> FitPaper(const std::vector<Sample>& samples) {
  std::map<std::string, Samples> by_geometry;
  for (const Sample& s : samples)
    if (s.slice.extent_m > 0) by_geometry[GeometryOf(s.slice.mode)].push_back(&s);
  PaperCoefficients coefficients;
  for (const auto& [name, of_geometry] : by_geometry) {
    if (of_geometry.size() < kMinSamples) return std::nullopt;
    const auto rows = static_cast<Eigen::Index>(of_geometry.size());
    Eigen::MatrixXd a(rows, kPaperFeatures + 1);
    Eigen::VectorXd b(rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const Sample& s = *of_geometry[static_cast<std::size_t>(i)];
      const auto features = PaperFeatures(BitsOfStep(s.slice.extent_m, s.settings.step_m),
                                          s.settings.level, s.slice.returns);
      for (std::size_t k = 0; k < kPaperFeatures; ++k)
        a(i, static_cast<Eigen::Index>(k)) = features[k];
      a(i, kPaperFeatures) = 1;
      b(i) = s.geometry_bytes + s.intensity_bytes;
    }
    const Eigen::VectorXd c = LeastSquares(a, b);
    PaperPolynomial& polynomial = coefficients.geometries[name];
    for (std::size_t k = 0; k < kPaperFeatures; ++k)
      polynomial.alpha[k] = c(static_cast<Eigen::Index>(k));
    polynomial.beta = c(kPaperFeatures);
  }
  if (coefficients.geometries.empty()) return std::nullopt;
  return coefficients;
}

FitError ErrorOf(const SizeModel& model, const std::vector<Sample>& samples) {
  std::vector<double> errors;
  double sum = 0;
  for (const Sample& s : samples) {
    const double real = s.geometry_bytes + s.intensity_bytes;
    if (real <= 0) continue;
    errors.push_back(std::abs(model.Predict(s.slice, s.settings).total() / real - 1));
    sum += errors.back();
  }
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  return {sum / static_cast<double>(errors.size()), errors[(errors.size() - 1) * 95 / 100]};
}

}  // namespace lidar::rate
