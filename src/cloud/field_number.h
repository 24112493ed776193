// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads and writes the numbers in point fields of any type.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "src/cloud/point_fields.h"

namespace lidar {

/// Calls `call` with a value of the C++ type that corresponds to `type`.
template <class Call>
decltype(auto) WithTypeOf(FieldType type, Call&& call) {
  switch (type) {
    case FieldType::kI8:
      return call(std::int8_t{});
    case FieldType::kU8:
      return call(std::uint8_t{});
    case FieldType::kI16:
      return call(std::int16_t{});
    case FieldType::kU16:
      return call(std::uint16_t{});
    case FieldType::kI32:
      return call(std::int32_t{});
    case FieldType::kU32:
      return call(std::uint32_t{});
    case FieldType::kF64:
      return call(double{});
    case FieldType::kF32:
      break;
  }
  return call(float{});
}

/// Reads a number in either byte order. Each of the types fits a double exactly.
inline double ReadNumber(const std::uint8_t* from, FieldType type, bool big_endian = false) {
  return WithTypeOf(type, [&](auto value) {
    std::uint8_t bytes[sizeof value];
    std::memcpy(bytes, from, sizeof value);
    if (big_endian) std::reverse(bytes, bytes + sizeof value);
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
  });
}

/// Writes the number of this type that is nearest to `value`. For integer types, NaN is written as
/// 0.
inline void WriteNumber(double value, FieldType type, std::uint8_t* to) {
  WithTypeOf(type, [&](auto stored) {
    using T = decltype(stored);
    if constexpr (std::numeric_limits<T>::is_integer) {
      const double low = std::numeric_limits<T>::min();
      const double high = std::numeric_limits<T>::max();
      if (!std::isnan(value)) stored = static_cast<T>(std::clamp(std::nearbyint(value), low, high));
    } else {
      stored = static_cast<T>(value);
    }
    std::memcpy(to, &stored, sizeof stored);
  });
}

}  // namespace lidar
