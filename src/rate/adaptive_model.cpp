// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/adaptive_model.h"

#include <algorithm>
#include <cmath>

#include "src/rate/paper_model.h"

namespace lidar::rate {
namespace {

constexpr double kUnitStep = 0.01;
// The model ignores slices with fewer returns, because headers are most of their bytes.
constexpr std::uint32_t kFewReturns = 64;
// A larger size per return is a fault, because even an uncoded return has fewer bytes.
constexpr double kMostBytesAReturn = 64;
constexpr double kMinSlope = 0.6;
constexpr double kMaxSlope = 1.6;
constexpr int kBisections = 40;
// The estimated ratio of intensity to geometry is within this factor of the fit. Codecs report only
// the sum of both. Without a limit, the estimate would drift until one of the two vanishes.
constexpr double kMostOffFit = 4;

double X(double step_m) { return std::log2(std::max(step_m, 1e-9) / kUnitStep); }
double N(double returns) { return std::log2(std::max(returns, 1.0) / 1000); }
double Cubic(const std::array<double, 4>& c, double x) {
  return c[0] + x * (c[1] + x * (c[2] + x * c[3]));
}
double CubicSlope(const std::array<double, 4>& c, double x) {
  return c[1] + x * (2 * c[2] + x * 3 * c[3]);
}

void Keep(const SliceFeatures& slice, Anchor anchor, double error, bool again,
          SliceTracker* tracker) {
  if (again)
    tracker->Replace(slice.slice_index, slice.slice_count, anchor);
  else
    tracker->Observe(slice.slice_index, slice.slice_count, anchor, error);
}

}  // namespace

double ModeCoefficients::GeometryLog2(double x, double n) const {
  const double inside = std::clamp(x, min_x, max_x);
  return Cubic(step, inside) + CubicSlope(step, inside) * (x - inside) + returns * n;
}

double ModeCoefficients::IntensityLog2(double bits, double n) const {
  return intensity[0] + intensity[1] * std::log2(std::max(bits, 1.0)) + intensity_returns * n;
}

bool ModeCoefficients::Falls() const {
  constexpr int kSteps = 64;
  constexpr double kFlattest = -0.01;
  for (int i = 0; i <= kSteps; ++i)
    if (CubicSlope(step, min_x + (max_x - min_x) * i / kSteps) > kFlattest) return false;
  return true;
}

const ModeCoefficients& AdaptiveModel::Mode(const std::string& mode) const {
  const auto found = coefficients_.modes.find(mode);
  return found == coefficients_.modes.end() ? coefficients_.fallback : found->second;
}

const AdaptiveModel::Learned* AdaptiveModel::LearnedOf(const std::string& mode) const {
  const bool same_geometry = GeometryOf(mode) == GeometryOf(last_mode_);
  const auto found = learned_.find(same_geometry ? last_mode_ : mode);
  return found == learned_.end() ? nullptr : &found->second;
}

double AdaptiveModel::GeometryLog2(const SliceFeatures& slice, double step_m) const {
  const ModeCoefficients& mode = Mode(slice.mode);
  const double n = N(slice.returns);
  const double fit = mode.GeometryLog2(X(step_m), n);
  const Learned* l = LearnedOf(slice.mode);
  if (l == nullptr) return fit;
  const auto anchor = l->geometry.Predict(slice.slice_index, slice.slice_count);
  if (!anchor) return fit;
  const double start = mode.GeometryLog2(anchor->x, n);
  return start + l->slope * (fit - start) + anchor->residual;
}

PredictedSize AdaptiveModel::Predict(const SliceFeatures& slice, const Settings& settings) const {
  if (slice.returns == 0) return {};
  PredictedSize size;
  size.geometry_bytes = std::exp2(GeometryLog2(slice, settings.step_m));
  if (settings.intensity_bits == 0) return size;
  double log2 = Mode(slice.mode).IntensityLog2(settings.intensity_bits, N(slice.returns));
  if (const Learned* l = LearnedOf(slice.mode))
    if (const auto anchor = l->intensity.Predict(slice.slice_index, slice.slice_count))
      log2 += anchor->residual;
  size.intensity_bytes = std::exp2(log2);
  return size;
}

Settings AdaptiveModel::Choose(const SliceFeatures& slice, double bytes,
                               const SettingLimits& limits) const {
  Settings settings{limits.coarsest_step_m, limits.intensity_bits, limits.level};
  const double geometry = bytes - Predict(slice, settings).intensity_bytes;
  double low = X(limits.finest_step_m);
  double high = X(limits.coarsest_step_m);
  if (slice.returns > 0 && geometry > 0) {
    const double wanted = std::log2(geometry);
    for (int i = 0; i < kBisections && low < high; ++i) {
      const double middle = (low + high) / 2;
      const double size = GeometryLog2(slice, kUnitStep * std::exp2(middle));
      (size > wanted ? low : high) = middle;
    }
    settings.step_m = kUnitStep * std::exp2((low + high) / 2);
  }
  // Chooses the finer allowed step, with two exceptions: its size exceeds kMostOver times `bytes`,
  // or the size at the coarser step is nearer to `bytes`.
  constexpr double kMostOver = 1.06;
  const AllowedSteps steps = StepsAround(settings.step_m, limits);
  settings.step_m = steps.coarser_m;
  const double less = Predict(slice, settings).total();
  settings.step_m = steps.finer_m;
  const double more = Predict(slice, settings).total();
  if (more > kMostOver * bytes || more - bytes > bytes - less) settings.step_m = steps.coarser_m;
  return settings;
}

void AdaptiveModel::LearnGeometry(Learned* learned, const SliceFeatures& slice, double x,
                                  double observed, bool again) {
  constexpr double kGain = 0.3;
  constexpr double kNoise = 0.02;  // (log2 units)^2: smaller moves of the step have little effect
  const ModeCoefficients& mode = Mode(slice.mode);
  const double n = N(slice.returns);
  const double error = observed - GeometryLog2(slice, kUnitStep * std::exp2(x));
  const Anchor anchor{x, observed - mode.GeometryLog2(x, n)};
  if (const auto from = learned->geometry.Predict(slice.slice_index, slice.slice_count)) {
    const double move = mode.GeometryLog2(x, n) - mode.GeometryLog2(from->x, n);
    learned->slope = std::clamp(learned->slope + kGain * error * move / (move * move + kNoise),
                                kMinSlope, kMaxSlope);
  }
  Keep(slice, anchor, error, again, &learned->geometry);
}

void AdaptiveModel::LearnIntensity(Learned* learned, const SliceFeatures& slice, double bits,
                                   double observed, bool again) {
  const double residual = observed - Mode(slice.mode).IntensityLog2(bits, N(slice.returns));
  const auto from = learned->intensity.Predict(slice.slice_index, slice.slice_count);
  const double error = residual - (from ? from->residual : 0);
  Keep(slice, {bits, residual}, error, again, &learned->intensity);
}

double AdaptiveModel::IntensityShare(const SliceFeatures& slice, double step_m, unsigned bits,
                                     const PredictedSize& predicted) const {
  if (bits == 0) return 0;
  const ModeCoefficients& mode = Mode(slice.mode);
  const double n = N(slice.returns);
  const double fit = std::exp2(mode.IntensityLog2(bits, n) - mode.GeometryLog2(X(step_m), n));
  const double ratio = std::clamp(predicted.intensity_bytes / predicted.geometry_bytes,
                                  fit / kMostOffFit, fit * kMostOffFit);
  return ratio / (1 + ratio);
}

void AdaptiveModel::OnEncoded(const SliceFeatures& slice, const Settings& settings,
                              const EncodedSize& encoded) {
  const double bytes = static_cast<double>(encoded.size.bytes());
  if (slice.returns < kFewReturns || bytes < 2 || bytes > slice.returns * kMostBytesAReturn ||
      !(encoded.step_m > 0))
    return;
  const PredictedSize predicted = Predict(slice, {encoded.step_m, settings.intensity_bits, 0});
  const double intensity =
      bytes * IntensityShare(slice, encoded.step_m, settings.intensity_bits, predicted);
  double observed = std::log2(bytes - intensity);
  if (!std::isfinite(observed)) return;
  if (const Learned* known = LearnedOf(slice.mode); known != nullptr && last_mode_ != slice.mode)
    learned_[slice.mode] = Learned(*known);
  last_mode_ = slice.mode;
  Learned& learned = learned_[slice.mode];
  double kept = 0;  // log2 of the part of the returns that was kept
  if (encoded.keep_fraction < 1) {
    kept = std::log2(std::max(encoded.keep_fraction, 1e-6));
    const double error = observed - learned.thinning * kept - std::log2(predicted.geometry_bytes);
    learned.thinning =
        std::clamp(learned.thinning + 0.1 * error * kept / (kept * kept + 0.1), 0.4, 1.2);
    observed -= learned.thinning * kept;
  }
  const std::uint64_t id = std::uint64_t{slice.scan_id} << 32 | slice.slice_index;
  const bool again = learned.last_slice == id;
  learned.last_slice = id;
  LearnGeometry(&learned, slice, X(encoded.step_m), observed, again);
  if (settings.intensity_bits > 0 && intensity > 0)
    LearnIntensity(&learned, slice, settings.intensity_bits, std::log2(intensity) - kept, again);
}

}  // namespace lidar::rate
