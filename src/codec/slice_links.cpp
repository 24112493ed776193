// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/slice_links.h"

#include "src/base/crc.h"
#include "src/codec/range_header.h"

namespace lidar::codec {

std::optional<std::vector<BlockName>> LinksOf(ByteView slice) {
  std::vector<BlockName> names;
  ByteReader reader(slice);
  do {
    ByteReader whole = reader;
    const auto header = RangeHeader::Read(&reader);
    if (!header) return std::nullopt;
    reader.Bytes(header->mask_size);
    ByteReader payload(reader.Bytes(header->payload_size));
    if (!reader.ok()) return std::nullopt;
    if (header->coder != RangeCoder::kTemporal) continue;
    BlockName name;
    const bool has_reference = payload.U8() != 0;
    if (has_reference) name.reference = payload.Le32();
    if (!payload.ok()) return std::nullopt;
    name.crc = Crc32(whole.Bytes(reader.position() - whole.position()));
    names.push_back(name);
  } while (reader.remaining() > 0);
  return names;
}

}  // namespace lidar::codec
