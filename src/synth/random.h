// SPDX-License-Identifier: LGPL-2.1-or-later
// Random numbers that depend on a place in the world, and not on the order of calls. So the world
// and the noise are the same however a scan is divided.
#pragma once
#include <cstdint>

namespace lidar::synth {

/// Mixes bits by SplitMix64's finaliser. Every bit of `v` affects every bit of the result.
constexpr std::uint64_t Mix(std::uint64_t v) {
  v += 0x9E3779B97F4A7C15ULL;
  v = (v ^ (v >> 30)) * 0xBF58476D1CE4E5B9ULL;
  v = (v ^ (v >> 27)) * 0x94D049BB133111EBULL;
  return v ^ (v >> 31);
}

/// The random numbers of one thing in the world.
class Random {
 public:
  explicit constexpr Random(std::uint64_t key) : state_(Mix(key)) {}
  /// Makes the random numbers of the thing `index` of kind `kind`.
  constexpr Random(std::uint64_t seed, std::uint64_t kind, std::int64_t index)
      : state_(Mix(Mix(seed ^ (kind << 56)) + static_cast<std::uint64_t>(index))) {}

  constexpr std::uint64_t Bits() { return state_ = Mix(state_); }
  /// Returns a number in [0, 1).
  constexpr float Uniform() { return static_cast<float>(Bits() >> 40) * 0x1p-24F; }
  constexpr float Uniform(float low, float high) { return low + (high - low) * Uniform(); }
  constexpr bool Chance(float p) { return Uniform() < p; }

 private:
  std::uint64_t state_;
};

}  // namespace lidar::synth
