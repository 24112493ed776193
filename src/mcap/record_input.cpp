// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/mcap/record_input.h"

#include <algorithm>

namespace lidar::mcap {

std::optional<RecordPlace> RecordAt(Input* input, std::uint64_t offset) {
  std::array<std::uint8_t, kRecordHeaderSize> bytes{};
  if (offset > input->size() || input->size() - offset < bytes.size() ||
      !input->Read(offset, bytes.size(), bytes.data()))
    return std::nullopt;
  ByteReader r(bytes.data(), bytes.size());
  RecordPlace place;
  place.op = static_cast<Op>(r.U8());
  place.size = r.Le64();
  place.content = offset + bytes.size();
  // Opcode 0 is invalid. Accepting it would make a hole in a sparse file a very long sequence of
  // empty records.
  constexpr Op kNone{0};
  if (place.op == kNone || place.size > input->size() - place.content) return std::nullopt;
  return place;
}

bool ReadContent(Input* input, const RecordPlace& record, std::uint64_t most, Bytes* out) {
  out->resize(static_cast<std::size_t>(std::min(record.size, most)));
  return input->Read(record.content, out->size(), out->data());
}

bool HasMagic(Input* input, std::uint64_t offset) {
  std::array<std::uint8_t, kMagic.size()> bytes{};
  return offset <= input->size() && input->size() - offset >= bytes.size() &&
         input->Read(offset, bytes.size(), bytes.data()) && bytes == kMagic;
}

}  // namespace lidar::mcap
