// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/model_fit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace lidar::rate {
namespace {

constexpr std::size_t kMaxDegree = 3;

using Samples = std::vector<const Sample*>;

double X(const Sample& s) { return std::log2(s.settings.step_m / kUnitStep); }
double N(const Sample& s) { return std::log2(s.slice.returns / 1000.0); }

double Dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}
/// a -= factor * b
void Subtract(std::vector<double>* a, double factor, const std::vector<double>& b) {
  for (std::size_t i = 0; i < b.size(); ++i) (*a)[i] -= factor * b[i];
}

/// Linear least squares, by the QR decomposition of modified Gram-Schmidt.
class LeastSquares {
 public:
  explicit LeastSquares(std::size_t features) : columns_(features) {}

  void Add(const std::vector<double>& features, double value) {
    for (std::size_t k = 0; k < columns_.size(); ++k) columns_[k].push_back(features[k]);
    values_.push_back(value);
  }

  /// A coefficient for each feature; 0 for one that the features before it tell already.
  std::vector<double> Solve() {
    const std::size_t n = columns_.size();
    std::vector<std::vector<double>> upper(n, std::vector<double>(n));
    std::vector<double> solution(n);
    for (std::size_t k = 0; k < n; ++k) {
      std::vector<double>& column = columns_[k];
      const double length = std::sqrt(Dot(column, column));
      for (std::size_t j = 0; j < k; ++j) {
        upper[j][k] = Dot(columns_[j], column);
        Subtract(&column, upper[j][k], columns_[j]);
      }
      const double rest = std::sqrt(Dot(column, column));
      upper[k][k] = rest > 1e-9 * length ? rest : 0;
      for (double& x : column) x = upper[k][k] > 0 ? x / rest : 0;
      solution[k] = Dot(column, values_);
      Subtract(&values_, solution[k], column);
    }
    for (std::size_t k = n; k-- > 0;) {
      for (std::size_t j = k + 1; j < n; ++j) solution[k] -= upper[k][j] * solution[j];
      solution[k] = upper[k][k] > 0 ? solution[k] / upper[k][k] : 0;
    }
    return solution;
  }

 private:
  std::vector<std::vector<double>> columns_;
  std::vector<double> values_;
};

/// Fits the exponent of the returns too, where their number varies enough to tell it.
double ReturnsSpread(const Samples& samples) {
  const auto [low, high] = std::minmax_element(
      samples.begin(), samples.end(),
      [](const Sample* a, const Sample* b) { return a->slice.returns < b->slice.returns; });
  return N(**high) - N(**low);
}

void FitGeometry(const Samples& samples, std::size_t degree, ModeCoefficients* mode) {
  constexpr double kEnoughSpread = 0.5;  // doublings
  const bool fit_returns = ReturnsSpread(samples) > kEnoughSpread;
  LeastSquares fit(degree + 1 + (fit_returns ? 1 : 0));
  for (const Sample* s : samples) {
    std::vector<double> features;
    for (std::size_t k = 0; k <= degree; ++k)
      features.push_back(std::pow(X(*s), static_cast<double>(k)));
    features.push_back(N(*s));
    fit.Add(features, std::log2(s->geometry_bytes) - (fit_returns ? 0 : N(*s)));
  }
  const std::vector<double> c = fit.Solve();
  mode->step = {};
  for (std::size_t k = 0; k <= degree; ++k) mode->step[k] = c[k];
  mode->returns = fit_returns ? c[degree + 1] : 1;
}

void FitIntensity(const Samples& all, ModeCoefficients* mode) {
  Samples samples;
  std::copy_if(all.begin(), all.end(), std::back_inserter(samples), [](const Sample* s) {
    return s->settings.intensity_bits > 0 && s->intensity_bytes > 1;
  });
  // Without a sample: half a bit a return and bit, to be corrected by the first slice.
  mode->intensity = {std::log2(1000 / 16.0), 1};
  mode->intensity_returns = 1;
  if (samples.size() < kMinSamples) return;
  LeastSquares fit(2);
  for (const Sample* s : samples)
    fit.Add({1, std::log2(static_cast<double>(s->settings.intensity_bits))},
            std::log2(s->intensity_bytes) - N(*s));
  const std::vector<double> c = fit.Solve();
  if (c[1] >= 0) mode->intensity = {c[0], c[1]};
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
  for (std::size_t degree = kMaxDegree; degree >= 1; --degree) {
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
    LeastSquares fit(kPaperFeatures + 1);
    for (const Sample* s : of_geometry) {
      const auto features = PaperFeatures(BitsOfStep(s->slice.extent_m, s->settings.step_m),
                                          s->settings.level, s->slice.returns);
      std::vector<double> row(features.begin(), features.end());
      row.push_back(1);
      fit.Add(row, s->geometry_bytes + s->intensity_bytes);
    }
    const std::vector<double> c = fit.Solve();
    PaperPolynomial& polynomial = coefficients.geometries[name];
    std::copy_n(c.begin(), kPaperFeatures, polynomial.alpha.begin());
    polynomial.beta = c[kPaperFeatures];
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
