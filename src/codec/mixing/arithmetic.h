// SPDX-License-Identifier: LGPL-2.1-or-later
// The arithmetic of the mixing coder: probabilities, logits, and tables that convert one to the
// other.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

namespace lidar::codec::mixing {

/// A chance is the probability that a bit is 1, in 1/65536. It is from kLeastChance to kMostChance.
constexpr std::int32_t kOne = 65'536;
constexpr std::int32_t kLeastChance = 16;
constexpr std::int32_t kMostChance = kOne - 17;
/// Logits are in 1/256 nat, from -kMostLogit to kMostLogit.
constexpr std::int32_t kMostLogit = 2'047;

/// Returns the number of bits of `value` without leading zeros; 0 for 0.
inline int BitLength(std::uint32_t value) { return value == 0 ? 0 : 32 - __builtin_clz(value); }

inline std::int32_t ClampLogit(std::int32_t logit) {
  return std::min(std::max(logit, -kMostLogit), kMostLogit);
}

/// The compiler computes the tables from integers, so the tables are the same on every machine.
struct Tables {
  constexpr Tables();
  std::array<std::uint16_t, 4'096> chance{};      // chance of the logit i - 2048
  std::array<std::int16_t, 4'096> logit{};        // logit of the chance 16 i + 8
  std::array<std::uint16_t, 256> log_mantissa{};  // 256 ln(1 + i / 256)
};
extern const Tables kTables;

inline std::int32_t Chance(std::int32_t logit) {
  return kTables.chance[static_cast<std::size_t>(ClampLogit(logit) + 2'048)];
}
inline std::int32_t Logit(std::uint32_t chance) { return kTables.logit[chance >> 4]; }

/// Returns 256 ln(`value`). `value` is from 1 to 65,535.
inline std::int32_t Log(std::uint32_t value) {
  const int bits = BitLength(value);
  const std::uint32_t mantissa = (value << 16 >> (bits - 1)) - 65'536;
  constexpr std::int32_t kLog2 = 45'426;  // 65536 ln 2
  return ((bits - 1) * kLog2 >> 8) + kTables.log_mantissa[mantissa >> 8];
}

/// Returns the rate, in 1/65536, at which a counter adapts when it has seen `bits` bits.
constexpr std::uint16_t RateAfter(unsigned bits) {
  return static_cast<std::uint16_t>(bits == 0 ? 40'000 : kOne / (static_cast<int>(bits) + 2));
}

/// An adaptive estimate of the chance that a bit is 1. It adapts more slowly with each bit: within
/// about 300 bits, `rate` falls to 255.
struct Counter {
  std::uint16_t rate = RateAfter(0);
  std::uint16_t chance = kOne / 2;

  /// Returns the vote of the counter. `logit` is the logit of `chance`. The vote is this logit, but
  /// nearer to 0 if the counter has seen only a few bits.
  std::int32_t Vote(std::int32_t logit) const {
    const std::int32_t sure = 65'535 - (rate + (rate >> 1));
    return logit * 2 * (sure >> 1) >> 16;
  }
  void Learn(bool bit) {
    const std::uint32_t mirror = bit ? 65'535 : 0;
    const std::uint32_t miss = chance ^ mirror;
    chance = static_cast<std::uint16_t>((miss - (miss * rate >> 16)) ^ mirror);
    // The rate becomes about rate / (1 + rate), both as fractions of kOne. After n bits it is thus
    // about 1/n.
    const std::uint32_t square = std::uint32_t{rate} * rate >> 16;
    rate = static_cast<std::uint16_t>(rate - (rate * (rate - (square >> 1)) >> 16));
  }
};

}  // namespace lidar::codec::mixing
