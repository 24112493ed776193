// SPDX-License-Identifier: LGPL-2.1-or-later
// Fits a sine wave to elevations.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lidar::codec::cloud {

struct Sample {
  double firing;
  double elevation;
};

/// elevation = middle + cosine cos(angle firing) + sine sin(angle firing)
struct Wave {
  double middle = 0;
  double cosine = 0;
  double sine = 0;
  double left = 0;  // mean square of the residuals
};

/// Sums of a least-squares fit.
class WaveSums {
 public:
  void Add(double cosine, double sine, double elevation) {
    const std::array<double, 4> row = {1, cosine, sine, elevation};
    for (unsigned i = 0; i < 4; ++i)
      for (unsigned k = i; k < 4; ++k) sums_[i][k] += row[i] * row[k];
  }
  /// Returns zeros if nothing was added.
  Wave Solve() const;

 private:
  std::array<std::array<double, 4>, 4> sums_{};
};

/// Returns about `most` of the samples.
std::vector<Sample> SomeOf(const std::vector<Sample>& samples, std::size_t most);
Wave FitWave(const std::vector<Sample>& samples, double angle);
/// Returns the angle a firing at which elevations swing, roughly.
double CoarseAngle(const std::vector<Sample>& samples, std::uint32_t firings);
/// Returns the best angle near `angle`.
double FineAngle(const std::vector<Sample>& samples, std::uint32_t firings, double angle);

}  // namespace lidar::codec::cloud
