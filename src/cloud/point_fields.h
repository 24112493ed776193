// SPDX-License-Identifier: LGPL-2.1-or-later
// The layout of one point: named, typed fields at byte offsets, after ROS 2 PointCloud2.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lidar {

enum class FieldType { kI8, kU8, kI16, kU16, kI32, kU32, kF32, kF64 };

std::size_t SizeOf(FieldType type);

struct PointField {
  std::string name;
  FieldType type;
  std::uint32_t offset;  // bytes from the start of the point
};
bool operator==(const PointField& a, const PointField& b);

class PointFields {
 public:
  PointFields() = default;
  /// Appends a field after the last one.
  PointFields& Add(std::string name, FieldType type);

  /// Parses the caps field `fields`: "x:F32:0,y:F32:4,z:F32:8". Returns nothing for an unknown
  /// type, an empty or repeated name, more than kMaxFields, or an offset past kMaxPointStep; `why`
  /// then says which, for a user.
  static std::optional<PointFields> Parse(std::string_view text, std::string* why = nullptr);
  std::string ToString() const;

  /// Null if there is no such field.
  const PointField* Find(std::string_view name) const;
  bool Has(std::string_view name, FieldType type) const;
  /// Returns true if x, y and z are adjacent F32 in this order, as all elements need them.
  bool HasPackedXyz() const;
  /// Returns true if the fields, in any order, fill the point from 0 without overlap or gaps, as
  /// decoders produce it.
  bool ArePacked() const;
  /// Bytes up to the end of the last field.
  std::uint32_t MinimumStep() const;

  const std::vector<PointField>& all() const { return fields_; }
  bool empty() const { return fields_.empty(); }
  bool operator==(const PointFields& o) const { return fields_ == o.fields_; }
  bool operator!=(const PointFields& o) const { return !(*this == o); }

  static constexpr std::size_t kMaxFields = 32;
  static constexpr std::uint32_t kMaxPointStep = 1024;

 private:
  std::vector<PointField> fields_;
};

}  // namespace lidar
