// SPDX-License-Identifier: LGPL-2.1-or-later
// The numbers of the mixing coder: probabilities, their logits, and the tables between them.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

namespace lidar::codec::mixing {

/// Probabilities of a 1 are in 1/65536, from kLeastChance to kMostChance.
constexpr std::int32_t kOne = 65'536;
constexpr std::int32_t kLeastChance = 16;
constexpr std::int32_t kMostChance = kOne - 17;
/// Logits are in 1/256 nat, from -kMostLogit to kMostLogit.
constexpr std::int32_t kMostLogit = 2'047;

/// Position of the highest 1 bit, counted from 1; 0 for 0.
inline int BitLength(std::uint32_t value) { return value == 0 ? 0 : 32 - __builtin_clz(value); }

inline std::int32_t ClampLogit(std::int32_t logit) {
  return std::min(std::max(logit, -kMostLogit), kMostLogit);
}

/// The compiler computes the tables with integers, so that they are the same on every machine.
struct Tables {
  constexpr Tables();
  std::array<std::uint16_t, 4'096> chance{};      // of logit i - 2048
  std::array<std::int16_t, 4'096> logit{};        // of the chance 16 i + 8
  std::array<std::uint16_t, 256> log_mantissa{};  // 256 ln(1 + i / 256)
};
extern const Tables kTables;

inline std::int32_t Chance(std::int32_t logit) {
  return kTables.chance[static_cast<std::size_t>(ClampLogit(logit) + 2'048)];
}
inline std::int32_t Logit(std::uint32_t chance) { return kTables.logit[chance >> 4]; }

/// 256 ln(value); `value` is from 1 to 65,535.
inline std::int32_t Log(std::uint32_t value) {
  const int bits = BitLength(value);
  const std::uint32_t mantissa = (value << 16 >> (bits - 1)) - 65'536;
  constexpr std::int32_t kLog2 = 45'426;  // 65536 ln 2
  return ((bits - 1) * kLog2 >> 8) + kTables.log_mantissa[mantissa >> 8];
}

/// Rate at which a counter learns after `bits` bits, in 1/65536.
constexpr std::uint16_t RateAfter(unsigned bits) {
  return static_cast<std::uint16_t>(bits == 0 ? 40'000 : kOne / (static_cast<int>(bits) + 2));
}

/// An adaptive chance. Its rate falls to 255 within about 300 bits. Lanes hold eight counters.
struct Counter {
  std::uint16_t rate = RateAfter(0);
  std::uint16_t chance = kOne / 2;

  /// Vote of a counter whose logit is `logit`: the fewer bits the counter has seen, the nearer to
  /// 0.
  std::int32_t Vote(std::int32_t logit) const {
    const std::int32_t sure = 65'535 - (rate + (rate >> 1));
    return logit * 2 * (sure >> 1) >> 16;
  }
  void Learn(bool bit) {
    const std::uint32_t mirror = bit ? 65'535 : 0;
    const std::uint32_t miss = chance ^ mirror;
    chance = static_cast<std::uint16_t>((miss - (miss * rate >> 16)) ^ mirror);
    // The rate becomes about rate / (1 + rate), as a part of kOne: 1/n after n bits.
    const std::uint32_t square = std::uint32_t{rate} * rate >> 16;
    rate = static_cast<std::uint16_t>(rate - (rate * (rate - (square >> 1)) >> 16));
  }
};

}  // namespace lidar::codec::mixing
