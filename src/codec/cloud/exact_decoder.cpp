// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/exact_decoder.h"

#include <algorithm>
#include <cstring>

namespace lidar::codec::cloud {

bool ExactDecoder::Decode(ByteView stream) {
  part_ = {};
  if (!geometry_.Decode(stream)) return false;
  const ByteView section = geometry_.exact_section();
  if (section.empty()) return fields_.empty();
  const auto types = ExactTypesOf(section);
  const bool fits =
      types && std::equal(types->begin(), types->end(), fields_.begin(), fields_.end(),
                          [](FieldType type, const PointField& f) { return type == f.type; });
  return fits && DecodeExactPart(section, geometry_.places(), MostNodes(stream.size), &part_);
}

void ExactDecoder::Write(const CloudLayout& layout, std::uint8_t* raw) const {
  WriteXyz(geometry_.cloud(), layout, raw, part_.order);
  for (std::size_t k = 0; k < part_.fields.size(); ++k) {
    if (!layout.fields.Has(fields_[k].name, fields_[k].type)) continue;
    const std::uint32_t offset = layout.fields.Find(fields_[k].name)->offset;
    const auto& numbers = part_.fields[k].numbers;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const std::size_t at = part_.order.empty() ? i : part_.order[i];
      std::memcpy(raw + at * layout.point_step + offset, &numbers[i], SizeOf(fields_[k].type));
    }
  }
}

}  // namespace lidar::codec::cloud
