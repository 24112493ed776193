// SPDX-License-Identifier: LGPL-2.1-or-later
// The section after the geometry of a cloud: exact fields, and the order of points.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/cloud/point_fields.h"
#include "src/codec/cloud/firing_order.h"

namespace lidar::codec::cloud {

/// A field of all points.
struct ExactField {
  FieldType type = FieldType::kU8;
  std::vector<std::uint64_t> numbers;  // bits as in memory
};

/// Values and places of the points, in decoding order.
struct ExactPart {
  std::vector<ExactField> fields;
  bool keeps_order = false;
  std::vector<std::uint32_t> order;  // place of each point in the old cloud

  bool empty() const { return fields.empty() && !keeps_order; }
  /// Cost of decoding, in decoded numbers. The models of a field cost as much as kModels numbers.
  std::size_t Numbers(std::size_t points) const {
    constexpr std::size_t kModels = 256;
    return (points + kModels) * (fields.size() + (keeps_order ? 1 : 0));
  }
};

/// Appends the section. `part.order` must be set, even if the section does not keep it.
void EncodeExactPart(const PointPlaces& places, const ExactPart& part,
                     std::vector<std::uint8_t>* out);

/// Returns the types of the fields of a section, or nothing for a damaged header.
std::optional<std::vector<FieldType>> ExactTypesOf(ByteView section);

/// Decodes a section of at most `most_numbers`. Returns false, with `part` undefined, if it is
/// damaged or larger.
bool DecodeExactPart(ByteView section, const PointPlaces& places, std::size_t most_numbers,
                     ExactPart* part);

}  // namespace lidar::codec::cloud
