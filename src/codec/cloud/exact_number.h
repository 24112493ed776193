// SPDX-License-Identifier: LGPL-2.1-or-later
// Numbers of any type as integers, and back without loss.
#pragma once
#include <cstdint>
#include <vector>

#include "src/cloud/point_fields.h"

namespace lidar::codec::cloud {

// Hostile numbers may overflow, so the arithmetic wraps.
inline std::int64_t Plus(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}
inline std::int64_t Minus(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}
inline std::int64_t Times(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) * static_cast<std::uint64_t>(b));
}

/// The numbers of a field, each as the bits that it has in memory. A number has a rank, and the
/// next one that the form can hold has the next rank. Levels are proportional to numbers, for
/// predictions. Only sums, quotients and roundings of IEEE 754 are used, so that all machines
/// agree.
struct NumberForm {
  static constexpr unsigned kMostDecimals = 9;
  static constexpr int kLeastScale = -128;
  static constexpr int kMostScale = 127;
  /// Levels are in 1/kParts of an integer, of the last decimal, or of 2^-scale.
  static constexpr std::int64_t kParts = 16;

  FieldType type = FieldType::kU8;
  unsigned decimals = 0;  // of all numbers; 0: integers, or any floats
  int scale = 0;          // for any floats: exponent of the levels

  bool is_float() const { return type == FieldType::kF32 || type == FieldType::kF64; }
  std::int64_t RankOf(std::uint64_t bits) const;
  std::uint64_t WithRank(std::int64_t rank) const;
  /// Returns the level of the number with this rank.
  std::int64_t LevelOf(std::int64_t rank) const;
  /// Returns the rank of the number nearest to `level`.
  std::int64_t RankAt(std::int64_t level) const;
};

/// Returns the forms that can hold `numbers`, one or two.
std::vector<NumberForm> FormsFor(FieldType type, const std::vector<std::uint64_t>& numbers);

}  // namespace lidar::codec::cloud
