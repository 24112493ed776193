// SPDX-License-Identifier: LGPL-2.1-or-later
// A simulated codec. Sizes fall with the step, differ by sector, drift from scan to scan, and never
// match the model's coefficients.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "src/rate/rate_controller.h"

namespace lidar::rate {

class SyntheticCodec {
 public:
  struct Parameters {
    std::uint32_t slices = 8;
    double noise = 0.005;  // of each slice's size
    double drift = 0.007;  // of the scene's complexity, per scan
    double returns_per_scan = 60000;
    double scans_per_second = 10;
    double bits_per_return = 6;  // geometry at a step of 1 cm
  };

  explicit SyntheticCodec(const Parameters& p, unsigned seed = 1) : p_(p), random_(seed) {}

  SliceFeatures Features(std::uint32_t scan, std::uint32_t slice) {
    SliceFeatures f;
    f.scan_id = scan;
    f.slice_index = slice;
    f.slice_count = p_.slices;
    f.scans_per_second = p_.scans_per_second;
    const double sector = 1 + 0.35 * std::sin(2 * M_PI * slice / p_.slices);
    f.returns = static_cast<std::uint32_t>(p_.returns_per_scan / p_.slices * sector);
    f.extent_m = 80;
    f.mode = "synthetic";
    const double slices = p_.slices;
    log_complexity_ *= 1 - 0.02 / slices;  // returns slowly to the start value
    log_complexity_ += Normal() * p_.drift / std::sqrt(slices);
    slice_noise_ = std::exp(Normal() * p_.noise);
    return f;
  }

  EncodedSize Encode(const SliceFeatures& f, const Settings& s, double keep = 1) const {
    const double x = std::log2(s.step_m / 0.01);
    const double sector = 1 + 0.2 * std::cos(4 * M_PI * f.slice_index / f.slice_count);
    const double log2 = std::log2(p_.bits_per_return) - 0.42 * x - 0.02 * x * x;
    const double returns = f.returns * std::pow(keep, 0.85);
    const double geometry =
        20 + returns * std::exp2(log2) * sector * std::exp(log_complexity_) * slice_noise_ / 8;
    // Real captures need four bits per return for 8-bit intensities, and 1.2 for 5-bit intensities.
    const double intensity = returns * 4 * std::pow(s.intensity_bits / 8.0, 2.5) / 8;
    // NaN features result in an empty slice.
    const auto bytes = [](double b) {
      return DataSize::Bytes(
          static_cast<std::int64_t>(std::isfinite(b) ? std::clamp(b, 0., 1e12) : 0));
    };
    return {bytes(geometry + intensity), s.step_m, keep};
  }

 private:
  double Normal() { return std::normal_distribution<double>()(random_); }
  Parameters p_;
  std::mt19937 random_;
  double log_complexity_ = 0;
  double slice_noise_ = 1;
};

}  // namespace lidar::rate
