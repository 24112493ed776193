// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads fields of points, which may have any type.
#pragma once
#include <optional>
#include <string_view>

#include "src/cloud/field_number.h"

namespace lidar::gst {

/// Reads a field of a point as a float.
class FieldReader {
 public:
  explicit FieldReader(const PointField& field) : field_(field) {}
  float operator()(const std::uint8_t* point) const {
    return static_cast<float>(ReadNumber(point + field_.offset, field_.type));
  }
  /// Returns a reader for the first of `names` that is in `fields`, or nothing if none is.
  static std::optional<FieldReader> Find(const PointFields& fields,
                                         std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names)
      if (const PointField* field = fields.Find(name)) return FieldReader(*field);
    return std::nullopt;
  }

 private:
  PointField field_;
};

}  // namespace lidar::gst
