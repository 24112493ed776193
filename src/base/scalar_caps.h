// SPDX-License-Identifier: LGPL-2.1-or-later
// Caps of a stream whose fields are scalars or short arrays of doubles. Their text is a limited
// part of GStreamer's syntax (docs/wire-format.md), which can be parsed in linear time.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace lidar {

struct ScalarCaps {
  struct Fraction {
    std::int32_t numerator = 0;
    std::int32_t denominator = 1;
    bool operator==(const Fraction& o) const {
      return numerator == o.numerator && denominator == o.denominator;
    }
  };
  using Bytes = std::vector<std::uint8_t>;
  using Doubles = std::vector<double>;
  using Value = std::variant<std::string, bool, std::int32_t, std::uint32_t, std::int64_t,
                             std::uint64_t, float, double, Fraction, Bytes, Doubles>;
  struct Field {
    std::string name;
    Value value;
    bool operator==(const Field& o) const { return name == o.name && value == o.value; }
  };

  static constexpr std::size_t kMaxFields = 64;
  static constexpr std::size_t kMaxDoubles = 16;       // per field; enough for a transform
  static constexpr std::size_t kMaxName = 64;          // of a field or a media type [bytes]
  static constexpr std::size_t kMaxText = 128U << 10;  // [bytes]

  std::string media_type;
  std::vector<Field> fields;

  /// Parses a text. Returns nothing if the text does not conform to the grammar.
  static std::optional<ScalarCaps> Parse(std::string_view text);
  /// Returns the text that GStreamer would write for these caps. Returns nothing and sets `why`, a
  /// text for users, if Parse() would refuse that text.
  std::optional<std::string> ToText(std::string* why = nullptr) const;

  /// Returns the value of the field `name`, or null if there is no such field.
  const Value* Find(std::string_view name) const;
  bool operator==(const ScalarCaps& o) const {
    return media_type == o.media_type && fields == o.fields;
  }
};

}  // namespace lidar
