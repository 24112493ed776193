// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/range_header.h"

#include "src/base/byte_writer.h"
#include "src/codec/varint.h"

namespace lidar::codec {
namespace {

// Flags in the second byte of a header.
constexpr unsigned kGapsFlag = 0x80;
constexpr unsigned kThinnedFlag = 0x40;

bool IsKnown(std::uint8_t coder) {
  return coder >= static_cast<std::uint8_t>(RangeCoder::kDraco) &&
         coder <= static_cast<std::uint8_t>(RangeCoder::kBlended);
}

}  // namespace

void RangeHeader::Write(std::vector<std::uint8_t>* out) const {
  ByteWriter writer(out);
  writer.U8(static_cast<std::uint8_t>(kVersion << 4 | static_cast<std::uint8_t>(coder)));
  writer.U8(
      static_cast<std::uint8_t>(intensity.bits() | static_cast<unsigned>(intensity.full()) << 4 |
                                (has_gaps ? kGapsFlag : 0) | (kept_beams > 0 ? kThinnedFlag : 0)));
  for (const std::uint32_t v : {beams, first_column, columns, grid.unit_mm(), grid.parts()})
    WriteVarint(v, &writer);
  if (kept_beams > 0) WriteVarint(kept_beams, &writer);
  if (has_mask_stream()) WriteVarint(mask_size, &writer);
  WriteVarint(payload_size, &writer);
}

std::optional<RangeHeader> RangeHeader::Read(ByteReader* reader) {
  const std::uint8_t first = reader->U8();
  const std::uint8_t second = reader->U8();
  const unsigned bits = second & 15;
  const unsigned full = second >> 4 & 3;
  if (first >> 4 != kVersion || !IsKnown(first & 15)) return std::nullopt;
  bool ok = true;
  RangeHeader h;
  h.coder = static_cast<RangeCoder>(first & 15);
  h.has_gaps = (second & kGapsFlag) != 0;
  h.beams = ReadVarint(reader, &ok);
  h.first_column = ReadVarint(reader, &ok);
  h.columns = ReadVarint(reader, &ok);
  const std::uint32_t unit_mm = ReadVarint(reader, &ok);
  const std::uint32_t parts = ReadVarint(reader, &ok);
  const bool is_thinned = (second & kThinnedFlag) != 0;
  if (is_thinned) h.kept_beams = ReadVarint(reader, &ok);
  if (h.has_mask_stream()) h.mask_size = ReadVarint(reader, &ok);
  h.payload_size = ReadVarint(reader, &ok);
  h.grid = RangeGrid::OfParts(unit_mm, parts);
  if (!ok || !reader->ok() || bits > IntensityScale::kMaxBits ||
      full > static_cast<unsigned>(FullScale::kWord) || h.beams == 0 || h.beams > kMaxBeams ||
      h.columns == 0 || h.columns > kMaxColumns || h.first_column >= kMaxColumns ||
      !h.grid.IsValid() || (is_thinned && (h.kept_beams == 0 || h.kept_beams >= h.beams)) ||
      (h.has_mask_stream() && h.mask_size == 0) ||
      std::uint64_t{h.mask_size} + h.payload_size > reader->remaining()) {
    return std::nullopt;
  }
  h.intensity = IntensityScale(static_cast<FullScale>(full), bits);
  return h;
}

}  // namespace lidar::codec
