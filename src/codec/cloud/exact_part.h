// SPDX-License-Identifier: LGPL-2.1-or-later
// Fields that come back exactly, and the order of points: what follows the geometry of a cloud.
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
  std::vector<std::uint64_t> numbers;  // the bits that they have in memory
};

/// What is kept of points beside where they are, in the order in which decoders make them.
struct ExactPart {
  std::vector<ExactField> fields;
  bool keeps_order = false;
  std::vector<std::uint32_t> order;  // the place of each point among all, in the cloud as it was

  bool empty() const { return fields.empty() && !keeps_order; }
  /// How many numbers a decoder reads. The models of a field cost as much as some hundred.
  std::size_t Numbers(std::size_t points) const {
    constexpr std::size_t kModels = 256;
    return (points + kModels) * (fields.size() + (keeps_order ? 1 : 0));
  }
};

/// Appends the section. `part` always has an order.
void EncodeExactPart(const PointPlaces& places, const ExactPart& part,
                     std::vector<std::uint8_t>* out);

/// The types of the fields of a section; nothing if its header is damaged.
std::optional<std::vector<FieldType>> ExactTypesOf(ByteView section);

/// Decodes a section of at most so many numbers. Returns false, with `part` undefined, if it is
/// damaged.
bool DecodeExactPart(ByteView section, const PointPlaces& places, std::size_t most_numbers,
                     ExactPart* part);

}  // namespace lidar::codec::cloud
