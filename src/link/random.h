// SPDX-License-Identifier: LGPL-2.1-or-later
// Random numbers that are the same on every machine, unlike the standard distributions.
#pragma once
#include <cstdint>
#include <random>

namespace lidar::link {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Returns a number that is uniformly distributed in [0, 1).
  double Uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  /// Returns true with `probability`. Draws no number if it is 0, so that a feature that is off
  /// does not change the sequence of the others.
  bool Chance(double probability) { return probability > 0 && Uniform() < probability; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace lidar::link
