// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cloud/lzf.h"

namespace lidar {
namespace {

/// A back reference of three bytes gives 264: no data can give more than that.
constexpr std::size_t kMostPerByte = 88;

}  // namespace

std::optional<std::vector<std::uint8_t>> DecompressLzf(ByteView data, std::size_t size) {
  if (size / kMostPerByte > data.size) return std::nullopt;
  std::vector<std::uint8_t> out;
  out.reserve(size);
  ByteReader r(data);
  while (r.remaining() > 0 && r.ok()) {
    const std::size_t control = r.U8();
    if (control < 32) {  // a run of literals
      const ByteView literals = r.Bytes(control + 1);
      if (!r.ok() || literals.size > size - out.size()) return std::nullopt;
      out.insert(out.end(), literals.begin(), literals.end());
      continue;
    }
    std::size_t length = control >> 5;
    if (length == 7) length += r.U8();
    length += 2;
    const std::size_t distance = ((control & 31) << 8 | r.U8()) + 1;
    if (!r.ok() || distance > out.size() || length > size - out.size()) return std::nullopt;
    for (std::size_t i = 0; i < length; ++i) out.push_back(out[out.size() - distance]);
  }
  if (!r.ok() || out.size() != size) return std::nullopt;
  return out;
}

}  // namespace lidar
