// SPDX-License-Identifier: LGPL-2.1-or-later
// Decodes clouds with their exact fields, in their original order, from unchecked bytes.
#pragma once
#include <cstdint>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/cloud/point_fields.h"
#include "src/codec/cloud/cloud_decoder.h"
#include "src/codec/cloud/exact_part.h"

namespace lidar::codec::cloud {

/// For one thread at a time.
class ExactDecoder {
 public:
  /// `fields` are those that slices keep exactly, in this order.
  ExactDecoder(std::vector<PointField> fields, std::uint32_t max_points)
      : fields_(std::move(fields)), geometry_(max_points) {}

  /// Returns false, with the cloud undefined, for bytes that CloudDecoder refuses, and for fields
  /// that are damaged or of other types.
  bool Decode(ByteView stream);
  const CloudDecoder& geometry() const { return geometry_; }
  /// Exact fields and order of the points.
  const ExactPart& part() const { return part_; }
  std::size_t size() const { return geometry_.cloud().size(); }
  /// Writes the points in their original order, if the slice keeps it, with the fields of `layout`.
  void Write(const CloudLayout& layout, std::uint8_t* raw) const;

 private:
  std::vector<PointField> fields_;
  CloudDecoder geometry_;
  ExactPart part_;
};

}  // namespace lidar::codec::cloud
