// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the fields of points, whatever their type.
#pragma once
#include <cstring>
#include <optional>
#include <string_view>

#include "src/cloud/point_fields.h"

namespace lidar::gst {

/// One field of a point as a number.
class FieldReader {
 public:
  explicit FieldReader(const PointField& field) : field_(field) {}
  float operator()(const std::uint8_t* point) const {
    const std::uint8_t* at = point + field_.offset;
    switch (field_.type) {
      case FieldType::kI8:
        return static_cast<float>(Load<std::int8_t>(at));
      case FieldType::kU8:
        return static_cast<float>(*at);
      case FieldType::kI16:
        return static_cast<float>(Load<std::int16_t>(at));
      case FieldType::kU16:
        return static_cast<float>(Load<std::uint16_t>(at));
      case FieldType::kI32:
        return static_cast<float>(Load<std::int32_t>(at));
      case FieldType::kU32:
        return static_cast<float>(Load<std::uint32_t>(at));
      case FieldType::kF32:
        return Load<float>(at);
      case FieldType::kF64:
        return static_cast<float>(Load<double>(at));
    }
    return 0;
  }
  /// The first of `names` that is there.
  static std::optional<FieldReader> Find(const PointFields& fields,
                                         std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names)
      if (const PointField* field = fields.Find(name)) return FieldReader(*field);
    return std::nullopt;
  }

 private:
  template <class T>
  static T Load(const std::uint8_t* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
  }
  PointField field_;
};

}  // namespace lidar::gst
