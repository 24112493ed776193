// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes points with any fields as Draco files, in the format of ROS's draco_point_cloud_transport:
// each field is an attribute.
#pragma once
#include <cstdint>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/cloud/point_fields.h"

namespace lidar::draco {

/// A field: adjacent numbers of one type.
struct FieldOfPoints {
  FieldType type;
  std::uint32_t offset;  // bytes from the start of the point
  std::uint32_t count;
  bool is_position;
};

struct FieldLayout {
  std::vector<FieldOfPoints> fields;
  std::uint32_t point_step = 0;  // bytes

  static constexpr std::size_t kMaxFields = 64;
};

/// Codes numbers without rounding, and keeps the order of points. Returns false if there is no
/// point to code, or a field ends past the point.
bool EncodeFields(ByteView points, const FieldLayout& layout, std::vector<std::uint8_t>* out);

/// Returns whole points of the layout, with zeros between the fields. Returns false if the stream
/// is damaged, has more than `max_points`, or has attributes that are not the layout's fields.
bool DecodeFields(ByteView stream, const FieldLayout& layout, std::uint32_t max_points,
                  std::vector<std::uint8_t>* points);

}  // namespace lidar::draco
