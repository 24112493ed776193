// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/wave_fit.h"

#include <cmath>

namespace lidar::codec::cloud {

Wave WaveSums::Solve() const {
  const double count = sums_[0][0];
  if (count == 0) return {};
  auto a = sums_;
  for (unsigned i = 0; i < 4; ++i)
    for (unsigned k = 0; k < i; ++k) a[i][k] = a[k][i];
  for (unsigned i = 0; i < 3; ++i) {
    a[i][i] += 1e-9 * count;  // never 0
    for (unsigned row = 0; row < 4; ++row) {
      if (row == i) continue;
      const double factor = a[row][i] / a[i][i];
      for (unsigned k = i; k < 4; ++k) a[row][k] -= factor * a[i][k];
    }
  }
  return {a[0][3] / a[0][0], a[1][3] / a[1][1], a[2][3] / a[2][2], a[3][3] / count};
}

Wave FitWave(const std::vector<Sample>& samples, double angle) {
  WaveSums sums;
  for (const Sample& s : samples)
    sums.Add(std::cos(angle * s.firing), std::sin(angle * s.firing), s.elevation);
  return sums.Solve();
}

std::vector<Sample> SomeOf(const std::vector<Sample>& samples, std::size_t most) {
  std::vector<Sample> some;
  for (std::size_t i = 0; i < samples.size(); i += samples.size() / most + 1)
    some.push_back(samples[i]);
  return some;
}

double CoarseAngle(const std::vector<Sample>& samples, std::uint32_t firings) {
  constexpr std::uint32_t kPerLobe = 4;
  constexpr std::uint32_t kLeastPeriod = 32;  // [firings]
  const std::vector<Sample> some = SomeOf(samples, 400);
  const std::uint32_t parts = kPerLobe * firings;
  std::vector<std::array<double, 2>> waves;
  waves.reserve(parts);
  for (std::uint32_t i = 0; i < parts; ++i) {
    const double angle = 2 * M_PI * i / parts;
    waves.push_back({std::cos(angle), std::sin(angle)});
  }
  std::uint32_t best = 0;
  double least = 0;
  for (std::uint32_t candidate = kPerLobe; candidate < parts / kLeastPeriod; ++candidate) {
    WaveSums sums;
    for (const Sample& s : some) {
      const auto& wave = waves[candidate * static_cast<std::uint64_t>(s.firing) % parts];
      sums.Add(wave[0], wave[1], s.elevation);
    }
    const double left = sums.Solve().left;
    if (best > 0 && left >= least) continue;
    best = candidate;
    least = left;
  }
  return 2 * M_PI * best / parts;
}

double FineAngle(const std::vector<Sample>& samples, std::uint32_t firings, double angle) {
  constexpr double kFinest = 1e-5;  // error of the phase over all firings [rad]
  const std::vector<Sample> some = SomeOf(samples, 512);
  double least = FitWave(some, angle).left;
  for (double step = 1; step > kFinest; step /= 2) {
    for (const double other : {angle - step / firings, angle + step / firings}) {
      const double left = FitWave(some, other).left;
      if (left >= least) continue;
      least = left;
      angle = other;
    }
  }
  return angle;
}

}  // namespace lidar::codec::cloud
