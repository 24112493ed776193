// SPDX-License-Identifier: LGPL-2.1-or-later
// The exact section, which follows the geometry of a cloud: exact fields, and the original order of
// points.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/cloud/point_fields.h"
#include "src/codec/cloud/firing_order.h"

namespace lidar::codec::cloud {

/// The values that all points have in a field.
struct ExactField {
  FieldType type = FieldType::kU8;
  std::vector<std::uint64_t> numbers;  // each as the bits that it has in memory
};

/// The exact fields and original places of the points, in the order in which points are decoded.
struct ExactPart {
  std::vector<ExactField> fields;
  bool keeps_order = false;
  std::vector<std::uint32_t> order;  // place of each point in the original cloud

  bool empty() const { return fields.empty() && !keeps_order; }
  /// Returns the cost of decoding, as a number of decoded numbers. The models of a field cost as
  /// much as kModels numbers.
  std::size_t Numbers(std::size_t points) const {
    constexpr std::size_t kModels = 256;
    return (points + kModels) * (fields.size() + (keeps_order ? 1 : 0));
  }
};

/// Encodes `part` as a section and appends it to `out`. `part.order` must be set, even if the
/// section does not keep it.
void EncodeExactPart(const PointPlaces& places, const ExactPart& part,
                     std::vector<std::uint8_t>* out);

/// Returns the types of a section's fields, or nothing if the header is damaged.
std::optional<std::vector<FieldType>> ExactTypesOf(ByteView section);

/// Decodes a section. Returns false if the section is damaged, or if its decoding costs more than
/// `most_numbers`. `part` is then undefined.
bool DecodeExactPart(ByteView section, const PointPlaces& places, std::size_t most_numbers,
                     ExactPart* part);

}  // namespace lidar::codec::cloud
