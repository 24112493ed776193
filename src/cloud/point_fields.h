// SPDX-License-Identifier: LGPL-2.1-or-later
// The layout of a point: named and typed fields at byte offsets, like in ROS 2 PointCloud2.
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
  std::uint32_t offset;  // offset from the start of the point [bytes]
};
bool operator==(const PointField& a, const PointField& b);

class PointFields {
 public:
  PointFields() = default;
  /// Appends a field behind the last field.
  PointFields& Add(std::string name, FieldType type);

  /// Parses the caps field `fields`, for example "x:F32:0,y:F32:4,z:F32:8". Returns nothing if a
  /// type is unknown, if a name is empty or repeated, if there are more than kMaxFields fields, or
  /// if an offset exceeds kMaxPointStep. Sets `why` to a reason for the user.
  static std::optional<PointFields> Parse(std::string_view text, std::string* why = nullptr);
  std::string ToString() const;

  /// Returns the field, or null if there is no field of this name.
  const PointField* Find(std::string_view name) const;
  bool Has(std::string_view name, FieldType type) const;
  /// Returns true if x, y and z are F32 and adjacent in this order, which all elements require.
  bool HasPackedXyz() const;
  /// Returns true if the fields fill the point without gaps or overlaps, starting at offset 0. They
  /// may be in any order. Points from decoders are packed.
  bool ArePacked() const;
  /// Returns the offset of the end of the last field [bytes].
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
