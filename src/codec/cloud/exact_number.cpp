// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/exact_number.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "src/cloud/field_number.h"

namespace lidar::codec::cloud {
namespace {

/// A double can represent all integers below kExact.
constexpr unsigned kExactBits = 53;
constexpr double kExact = static_cast<double>(std::uint64_t{1} << kExactBits);
constexpr std::array<double, NumberForm::kMostDecimals + 1> kPowers = {1,   1e1, 1e2, 1e3, 1e4,
                                                                       1e5, 1e6, 1e7, 1e8, 1e9};

double NumberOf(std::uint64_t bits, FieldType type) {
  std::uint8_t bytes[8];
  std::memcpy(bytes, &bits, sizeof bytes);
  return ReadNumber(bytes, type);
}

std::uint64_t BitsOf(double value, FieldType type) {
  if (type == FieldType::kF32) {
    constexpr double kMost = static_cast<double>(std::numeric_limits<float>::max());
    value = std::clamp(value, -kMost, kMost);
  }
  std::uint8_t bytes[8] = {};
  WriteNumber(value, type, bytes);
  std::uint64_t bits = 0;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits;
}

unsigned BitsIn(FieldType type) { return static_cast<unsigned>(8 * SizeOf(type)); }

std::uint64_t MaskOf(FieldType type) { return UINT64_MAX >> (64 - BitsIn(type)); }

/// Returns the position of a float in the ascending order of all floats. -0 is just before 0.
std::int64_t Ordinal(std::uint64_t bits, FieldType type) {
  const std::uint64_t sign = std::uint64_t{1} << (BitsIn(type) - 1);
  const auto size = static_cast<std::int64_t>(bits & (sign - 1));
  return (bits & sign) != 0 ? -1 - size : size;
}
std::uint64_t AtOrdinal(std::int64_t ordinal, FieldType type) {
  const std::uint64_t sign = std::uint64_t{1} << (BitsIn(type) - 1);
  if (ordinal >= 0) return static_cast<std::uint64_t>(ordinal) & (sign - 1);
  return sign | (static_cast<std::uint64_t>(-1 - ordinal) & (sign - 1));
}

/// Returns the integer nearest to `value`. Returns 0 for NaN and for values from 2^53 on, because
/// doubles cannot represent all integers there.
std::int64_t NearestInteger(double value) {
  return std::abs(value) < kExact ? static_cast<std::int64_t>(std::floor(value + 0.5)) : 0;
}

bool Holds(const NumberForm& form, std::uint64_t bits) {
  return form.WithRank(form.RankOf(bits)) == bits;
}

}  // namespace

std::int64_t NumberForm::RankOf(std::uint64_t bits) const {
  if (!is_float()) return static_cast<std::int64_t>(NumberOf(bits, type));
  if (decimals == 0) return Ordinal(bits, type);
  return NearestInteger(NumberOf(bits, type) * kPowers[decimals]);
}

std::uint64_t NumberForm::WithRank(std::int64_t rank) const {
  if (!is_float()) return static_cast<std::uint64_t>(rank) & MaskOf(type);
  if (decimals == 0) return AtOrdinal(rank, type);
  return BitsOf(static_cast<double>(rank) / kPowers[decimals], type);
}

std::int64_t NumberForm::LevelOf(std::int64_t rank) const {
  const bool is_any = is_float() && decimals == 0;
  return Times(is_any ? NearestInteger(std::ldexp(NumberOf(WithRank(rank), type), scale)) : rank,
               kParts);
}

std::int64_t NumberForm::RankAt(std::int64_t level) const {
  if (is_float() && decimals == 0)
    return Ordinal(BitsOf(std::ldexp(static_cast<double>(level) / kParts, -scale), type), type);
  const std::int64_t up = Plus(level, kParts / 2);
  return up / kParts - (up % kParts < 0 ? 1 : 0);
}

std::vector<NumberForm> FormsFor(FieldType type, const std::vector<std::uint64_t>& numbers) {
  NumberForm form;
  form.type = type;
  if (!form.is_float()) return {form};
  double largest = 0;
  for (const std::uint64_t bits : numbers) {
    const double size = std::abs(NumberOf(bits, type));
    if (std::isfinite(size)) largest = std::max(largest, size);
  }
  int exponent = 0;
  std::frexp(largest, &exponent);
  form.scale = std::clamp(static_cast<int>(kExactBits) - exponent, NumberForm::kLeastScale,
                          NumberForm::kMostScale);
  std::vector<NumberForm> forms = {form};
  for (NumberForm exact{type, 1, 0}; exact.decimals <= NumberForm::kMostDecimals;
       ++exact.decimals) {
    const auto fits = [&](std::uint64_t bits) { return Holds(exact, bits); };
    if (!std::all_of(numbers.begin(), numbers.end(), fits)) continue;
    forms.push_back(exact);
    break;
  }
  return forms;
}

}  // namespace lidar::codec::cloud
