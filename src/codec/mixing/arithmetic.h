// SPDX-License-Identifier: LGPL-2.1-or-later
// The numbers of the mixing coder: probabilities, their logits, and the tables between them.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

namespace lidar::codec::mixing {

/// Probabilities of a 1 are in 1/65536, and stay between these.
constexpr std::int32_t kOne = 65'536;
constexpr std::int32_t kLeastChance = 16;
constexpr std::int32_t kMostChance = kOne - 17;
/// Logits are in 1/256 nat, and stay within +-kMostLogit.
constexpr std::int32_t kMostLogit = 2'047;

/// Position of the highest one, counted from 1; 0 for 0.
inline int BitLength(std::uint32_t value) { return value == 0 ? 0 : 32 - __builtin_clz(value); }

inline std::int32_t ClampLogit(std::int32_t logit) {
  return std::min(std::max(logit, -kMostLogit), kMostLogit);
}

/// Built from integers only, so that they are the same on every machine, and by the compiler, so
/// that they are there before anything runs.
struct Tables {
  constexpr Tables();
  std::array<std::uint16_t, 4'096> chance{};      // of logit i - 2048
  std::array<std::int16_t, 4'096> logit{};        // of the chance 16 i + 8
  std::array<std::uint16_t, 256> log_mantissa{};  // 256 ln(1 + i / 256)
  std::array<std::uint16_t, 256> rate{};          // of a counter after i visits, in 1/32768
  std::array<std::uint16_t, 256> confidence{};    // of a counter after i visits, in 1/65536
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

constexpr unsigned kMostVisits = 255;

/// An adaptive chance that remembers how often it was used.
struct Counter {
  std::uint16_t chance = kOne / 2;
  std::uint16_t visits = 0;

  /// What it has to say: its logit, the less the fewer visits it had.
  std::int32_t Vote() const { return Logit(chance) * kTables.confidence[visits] >> 16; }
  void Learn(bool bit) {
    const std::int32_t target = bit ? kOne - 1 : 0;
    chance = static_cast<std::uint16_t>(
        chance + ((target - chance) * std::int32_t{kTables.rate[visits]} >> 15));
    visits = static_cast<std::uint16_t>(visits + (visits < kMostVisits ? 1 : 0));
  }
};

}  // namespace lidar::codec::mixing
