// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts numbers of any type to integers, and back without loss.
#pragma once
#include <cstdint>
#include <vector>

#include "src/cloud/point_fields.h"

namespace lidar::codec::cloud {

// The arithmetic wraps around, because a malicious stream may have numbers that overflow.
inline std::int64_t Plus(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}
inline std::int64_t Minus(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}
inline std::int64_t Times(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) * static_cast<std::uint64_t>(b));
}

/// How the numbers of a field become integers. Each number is given as the bits that it has in
/// memory.
///
/// A number has a rank. The next larger number that the form can represent has the next rank. A
/// number also has a level, which is proportional to the number and is used for predictions.
///
/// Only sums, quotients and roundings of IEEE 754 are used, so that the results are the same on all
/// machines.
struct NumberForm {
  static constexpr unsigned kMostDecimals = 9;
  static constexpr int kLeastScale = -128;
  static constexpr int kMostScale = 127;
  /// The unit of levels is 1/kParts of an integer, of the last decimal, or of 2^-scale.
  static constexpr std::int64_t kParts = 16;

  FieldType type = FieldType::kU8;
  unsigned decimals = 0;  // decimals of all numbers; 0: integers, or any floats
  int scale = 0;          // exponent of the levels of any floats

  bool is_float() const { return type == FieldType::kF32 || type == FieldType::kF64; }
  std::int64_t RankOf(std::uint64_t bits) const;
  std::uint64_t WithRank(std::int64_t rank) const;
  /// Returns the level of the number with this rank.
  std::int64_t LevelOf(std::int64_t rank) const;
  /// Returns the rank of the number nearest to `level`.
  std::int64_t RankAt(std::int64_t level) const;
};

/// Returns the one or two forms that can represent `numbers`.
std::vector<NumberForm> FormsFor(FieldType type, const std::vector<std::uint64_t>& numbers);

}  // namespace lidar::codec::cloud
