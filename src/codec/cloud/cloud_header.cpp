// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/cloud_header.h"

#include <cmath>

#include "src/base/byte_writer.h"
#include "src/codec/varint.h"

namespace lidar::codec::cloud {
namespace {

constexpr unsigned kVersion = 1;
constexpr unsigned kBeamsFlag = 16;
constexpr unsigned kExactFlag = 32;
constexpr unsigned kScaleShift = 4;  // in the second byte

}  // namespace

void CloudHeader::Write(std::vector<std::uint8_t>* out) const {
  ByteWriter writer(out);
  writer.U8(static_cast<std::uint8_t>(kVersion | (has_beams ? kBeamsFlag : 0) |
                                      (has_exact_part ? kExactFlag : 0)));
  writer.U8(static_cast<std::uint8_t>(intensity.bits() | static_cast<unsigned>(intensity.full())
                                                             << kScaleShift));
  WriteVarint(points, &writer);
  WriteVarint(far_points, &writer);
  writer.LeF32(grid.step_m);
  writer.U8(static_cast<std::uint8_t>(depth));
  WriteVarint(stream_size, &writer);
}

std::optional<CloudHeader> CloudHeader::Read(ByteReader* reader) {
  const unsigned first = reader->U8();
  const unsigned second = reader->U8();
  const unsigned full = second >> kScaleShift;
  const unsigned bits = second & ((1U << kScaleShift) - 1);
  bool ok = true;
  CloudHeader h;
  h.has_beams = (first & kBeamsFlag) != 0;
  h.has_exact_part = (first & kExactFlag) != 0;
  h.points = ReadVarint(reader, &ok);
  h.far_points = ReadVarint(reader, &ok);
  h.grid.step_m = reader->LeF32();
  h.depth = reader->U8();
  h.stream_size = ReadVarint(reader, &ok);
  if (!ok || !reader->ok() || (first & ~(kBeamsFlag | kExactFlag)) != kVersion ||
      bits > IntensityScale::kMaxBits || full > static_cast<unsigned>(FullScale::kWord) ||
      (h.points + h.far_points == 0 && !h.has_beams) ||
      !(h.grid.step_m >= CellGrid::kFinest && h.grid.step_m <= CellGrid::kCoarsest) ||
      h.depth == 0 || h.depth > kMostDepth || h.stream_size > reader->remaining()) {
    return std::nullopt;
  }
  h.intensity = IntensityScale(static_cast<FullScale>(full), bits);
  return h;
}

}  // namespace lidar::codec::cloud
