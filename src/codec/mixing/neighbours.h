// SPDX-License-Identifier: LGPL-2.1-or-later
// The values around a pixel, and their classes for the contexts.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

#include "src/codec/mixing/arithmetic.h"

namespace lidar::codec::mixing {

/// The value of a return is the centre of its bin, in units of 1/kStep bin. It is at least 8, so no
/// return has the value kUnknown.
constexpr std::int32_t kStep = 16;
constexpr std::int32_t kUnknown = 0;

inline std::int32_t CentreOf(std::int32_t bin) { return kStep * bin + kStep / 2; }

/// The returns at one azimuth of the beams above the current beam.
struct Azimuth {
  std::array<std::int32_t, 3> values{};  // of the newest three returns, newest first
  std::int8_t residual = 0;              // prediction error in the beam above, -3 to 3
  std::uint8_t returns = 0xFF;           // a bit per beam above (bit 0: the nearest); 1: a return
  std::uint8_t level = 0;                // of the newest return
  std::int8_t level_residual = 0;
};

/// Returns the class of `value`. Each class is half an octave wide: 0, 1, 2, 3, 4-5, 6-7, 8-11, ...
inline std::uint32_t HalfOctave(std::uint32_t value) {
  if (value < 2) return value;
  const auto bits = static_cast<std::uint32_t>(BitLength(value) - 1);
  return 2 * bits + (value >> (bits - 1) & 1);
}

/// Returns the class, 0 to 23, of a sum of distances in 1/16 bin.
inline std::uint32_t UnevenClass(std::uint32_t sum) {
  if (sum < 4) return sum < 1 ? 0 : 1;
  return std::min(HalfOctave(sum) - 2, 23U);
}

/// Returns the class, 0 to 10, of a difference in 1/16 bin. Class 5 has differences of up to 0.5
/// bin. For each sign there are four classes up to 1.5, 2.5, 4.5 and 10 bins, and one for the rest.
inline std::uint32_t OffsetClass(std::int32_t difference) {
  static constexpr auto kClasses = [] {
    std::array<std::uint8_t, 323> classes{};
    for (std::int32_t i = 0; i < 323; ++i) {
      const std::int32_t size = i < 161 ? 161 - i : i - 161;
      const int c = size <= 7     ? 0
                    : size <= 23  ? 1
                    : size <= 39  ? 2
                    : size <= 71  ? 3
                    : size <= 160 ? 4
                                  : 5;
      classes[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(i < 161 ? 5 - c : 5 + c);
    }
    return classes;
  }();
  return kClasses[static_cast<std::size_t>(std::clamp(difference, -161, 161) + 161)];
}

/// Returns the class, 0 to 6, of a difference in 1/16 bin. Class 3 has differences of up to 0.5
/// bin. For each sign there are two classes up to 1.5 and 3.5 bins, and one for the rest.
inline std::uint32_t StepClass(std::int32_t difference) {
  const std::int32_t size = std::abs(difference);
  const int c = (size > 7 ? 1 : 0) + (size > 23 ? 1 : 0) + (size > 56 ? 1 : 0);
  return static_cast<std::uint32_t>(difference < 0 ? 3 - c : 3 + c);
}

/// Returns the class, 0 to 14, of `phase`: the neighbours' mean minus the prediction, in 1/16 bin.
inline std::uint32_t PhaseClass(std::int32_t phase) {
  static constexpr auto kClasses = [] {
    constexpr std::array<int, 14> kEnds = {-41, -25, -17, -13, -9, -5, -2, 1, 4, 8, 12, 16, 24, 40};
    std::array<std::uint8_t, 83> classes{};
    for (int i = 0; i < 83; ++i) {
      std::uint8_t c = 0;
      while (c < 14 && i - 41 > kEnds[c]) ++c;
      classes[static_cast<std::size_t>(i)] = c;
    }
    return classes;
  }();
  return kClasses[static_cast<std::size_t>(std::clamp(phase, -41, 41) + 41)];
}

/// Returns the class, 0 to 15, of the range `value`, which is in 1/16 bin. A bin is `step_mm` wide.
inline std::uint32_t RangeClass(std::int32_t value, std::int64_t step_mm) {
  const std::int64_t mm = value * step_mm / kStep;
  return std::min(HalfOctave(static_cast<std::uint32_t>(mm >> 7)), 15U);
}

/// Returns the class, 0 to 6, of a residual from -3 to 3. If `mirror` is -1, the residual is taken
/// with the opposite sign.
inline std::uint32_t ResidualClass(std::int32_t residual, std::int32_t mirror) {
  return static_cast<std::uint32_t>(residual * mirror + 3);
}

/// Returns the value that follows `far` and `near` on a straight wall. From one pixel of a straight
/// wall to the next, the inverse of the range changes by a constant.
inline std::int32_t Extrapolate(std::int32_t near, std::int32_t far) {
  const std::int64_t divisor = 2 * std::int64_t{far} - near;
  if (divisor <= 0) return near;
  // The quotient is near + step + 2 step^2 / divisor. The last term is mostly less than 1. It then
  // counts as 0, so no division is needed.
  const std::int64_t step = std::int64_t{near} - far;
  if (2 * step * step < divisor) return static_cast<std::int32_t>(near + step);
  return static_cast<std::int32_t>(
      std::min<std::int64_t>(std::int64_t{near} * far / divisor, 2 * std::int64_t{near}));
}

/// Returns the median of a, b and a + b - corner.
inline std::int32_t Median(std::int32_t a, std::int32_t b, std::int32_t corner) {
  return std::max(std::min(a, b), std::min(std::max(a, b), a + b - corner));
}

}  // namespace lidar::codec::mixing
