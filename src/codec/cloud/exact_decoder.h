// SPDX-License-Identifier: LGPL-2.1-or-later
// Decodes clouds with exact fields and in their original order. The bytes need not be checked
// before.
#pragma once
#include <cstdint>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/cloud/point_fields.h"
#include "src/codec/cloud/cloud_decoder.h"
#include "src/codec/cloud/exact_part.h"

namespace lidar::codec::cloud {

/// Not thread-safe.
class ExactDecoder {
 public:
  /// `fields` are the fields that slices keep exactly, in this order.
  ExactDecoder(std::vector<PointField> fields, std::uint32_t max_points)
      : fields_(std::move(fields)), geometry_(max_points) {}

  /// Decodes a slice. Returns false if CloudDecoder refuses `stream`, or if the exact fields are
  /// damaged or have other types. The cloud is then undefined.
  bool Decode(ByteView stream);
  const CloudDecoder& geometry() const { return geometry_; }
  /// Returns the exact fields and the order of the points.
  const ExactPart& part() const { return part_; }
  std::size_t size() const { return geometry_.cloud().size(); }
  /// Writes the points with the fields of `layout`. If the slice keeps the original order of the
  /// points, writes them in this order.
  void Write(const CloudLayout& layout, std::uint8_t* raw) const;

 private:
  std::vector<PointField> fields_;
  CloudDecoder geometry_;
  ExactPart part_;
};

}  // namespace lidar::codec::cloud
