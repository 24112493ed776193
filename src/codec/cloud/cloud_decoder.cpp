// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/cloud_decoder.h"

#include <algorithm>
#include <cmath>

#include "src/codec/cloud/level_tree.h"
#include "src/codec/mixing/binary_coder.h"
#include "src/codec/varint.h"

namespace lidar::codec::cloud {

bool CloudDecoder::Decode(ByteView stream) {
  cloud_.Clear();
  places_ = {};
  exact_section_ = {};
  ByteReader reader(stream);
  const auto header = CloudHeader::Read(&reader);
  if (!header || std::uint64_t{header->points} + header->far_points > max_points_) return false;
  header_ = *header;
  const std::size_t far_size =
      std::size_t{header_.far_points} * (3 * sizeof(float) + (intensity_bits() > 0 ? 1 : 0));
  if (far_size > reader.remaining()) return false;
  ByteReader far(reader.Bytes(far_size));
  const std::size_t others = std::size_t{header_.points} + header_.far_points;
  if (header_.has_beams && !section_.Decode(&reader, max_points_ - others, header_.intensity,
                                            &cloud_, header_.has_exact_part ? &places_ : nullptr)) {
    return false;
  }
  const ByteView cells = reader.Bytes(header_.stream_size);
  if (header_.has_exact_part) {
    bool ok = true;
    exact_section_ = reader.Bytes(ReadVarint(&reader, &ok));
    if (!ok || exact_section_.empty()) return false;
  }
  if (!reader.ok()) return false;
  const ByteView filler = reader.Rest();
  const bool filled = std::all_of(filler.begin(), filler.end(), [](auto b) { return b == 0; });
  if (!filled || !DecodeCells(cells, stream.size) || !ReadFarPoints(&far)) return false;
  if (header_.has_exact_part) places_.AddLoose(cloud_.size() - places_.points.size());
  return true;
}

bool CloudDecoder::DecodeCells(ByteView stream, std::size_t slice_bytes) {
  if (header_.points == 0) return stream.empty();
  mixing::BinaryDecoder decoder(stream);
  cells_.Clear();
  cells_.depth = header_.depth;
  if (!tree_.Code(&cells_, {header_.points, MostNodes(slice_bytes)}, &decoder)) return false;
  cloud_.xyz.reserve(cloud_.xyz.size() + 3 * std::size_t{header_.points});
  for (std::size_t i = 0; i < cells_.codes.size(); ++i) {
    const Point middle = header_.grid.Middle(PositionOf(cells_.codes[i]), header_.depth);
    for (std::uint32_t k = 0; k < cells_.counts[i]; ++k)
      cloud_.xyz.insert(cloud_.xyz.end(), middle.begin(), middle.end());
  }
  if (intensity_bits() > 0) {
    std::vector<std::uint8_t> levels(header_.points);
    if (!CodeLevels(cells_, intensity_bits(), &levels, &decoder)) return false;
    for (const std::uint8_t level : levels)
      cloud_.intensity.push_back(header_.intensity.ValueOf(level));
  }
  return decoder.AtEnd();
}

bool CloudDecoder::ReadFarPoints(ByteReader* reader) {
  for (std::uint32_t i = 0; i < header_.far_points; ++i) {
    for (unsigned k = 0; k < 3; ++k) {
      cloud_.xyz.push_back(reader->LeF32());
      if (!std::isfinite(cloud_.xyz.back())) return false;
    }
    if (intensity_bits() > 0) cloud_.intensity.push_back(header_.intensity.ValueOf(reader->U8()));
  }
  return reader->ok();
}

}  // namespace lidar::codec::cloud
