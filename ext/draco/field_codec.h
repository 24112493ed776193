// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes points with any fields as Draco files. The format is that of ROS's
// draco_point_cloud_transport, in which each field is an attribute.
#pragma once
#include <cstdint>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/cloud/point_fields.h"

namespace lidar::draco {

/// A field of a point. It consists of adjacent numbers of one type.
struct FieldOfPoints {
  FieldType type;
  std::uint32_t offset;  // offset from the start of the point [bytes]
  std::uint32_t count;
  bool is_position;
};

struct FieldLayout {
  std::vector<FieldOfPoints> fields;
  std::uint32_t point_step = 0;  // size of a point [bytes]

  static constexpr std::size_t kMaxFields = 64;
};

/// Encodes points without rounding, and keeps their order. Returns false if there are no points, or
/// if a field exceeds the size of a point.
bool EncodeFields(ByteView points, const FieldLayout& layout, std::vector<std::uint8_t>* out);

/// Decodes whole points of the layout. Gaps between the fields are zeros. Returns false if the
/// stream is damaged, if it has more than `max_points` points, or if its attributes are not the
/// fields of the layout.
bool DecodeFields(ByteView stream, const FieldLayout& layout, std::uint32_t max_points,
                  std::vector<std::uint8_t>* points);

}  // namespace lidar::draco
