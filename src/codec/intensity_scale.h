// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts intensities to a few levels, and back.
#pragma once
#include <algorithm>
#include <cstdint>

namespace lidar::codec {

/// The intensity of the highest level. It is 1 as in KITTI, or the largest integer of 8 or 16 bits,
/// as sensors send them. Higher intensities get the highest level, too.
enum class FullScale : std::uint8_t { kOne = 0, kByte = 1, kWord = 2 };

class IntensityScale {
 public:
  static constexpr unsigned kMaxBits = 8;

  constexpr IntensityScale() = default;
  constexpr IntensityScale(FullScale full, unsigned bits) : full_(full), bits_(bits) {
    if (full == FullScale::kOne) {
      step_ = 1.0F / static_cast<float>((1U << bits) - 1);
    } else {
      // Each level stands for the same number of integers, and decodes to their mean.
      const float integers = full == FullScale::kByte ? 256.0F : 65536.0F;
      step_ = integers / static_cast<float>(1U << bits);
      offset_ = (step_ - 1) / 2;
    }
  }
  static FullScale Fitting(float largest) {
    if (largest <= 1.0F) return FullScale::kOne;
    return largest <= 255.0F ? FullScale::kByte : FullScale::kWord;
  }

  unsigned bits() const { return bits_; }
  FullScale full() const { return full_; }
  /// Returns the level of `intensity`. NaN has level 0.
  std::uint8_t LevelOf(float intensity) const {
    const float level = (intensity - offset_) / step_ + 0.5F;
    const float top = static_cast<float>((1U << bits_) - 1);
    return static_cast<std::uint8_t>(level > 0 ? std::min(level, top) : 0.0F);
  }
  /// Converts `fine`, a level of the 8-bit scale with the same full scale, to a level of this
  /// scale.
  std::uint8_t Coarsen(std::uint8_t fine) const {
    if (full_ != FullScale::kOne) return static_cast<std::uint8_t>(fine >> (kMaxBits - bits_));
    return static_cast<std::uint8_t>((fine * ((1U << bits_) - 1) + 127) / 255);
  }
  float ValueOf(std::uint8_t level) const { return static_cast<float>(level) * step_ + offset_; }

 private:
  FullScale full_ = FullScale::kByte;
  unsigned bits_ = 0;
  float step_ = 1;
  float offset_ = 0;
};

}  // namespace lidar::codec
