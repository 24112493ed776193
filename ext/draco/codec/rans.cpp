// SPDX-License-Identifier: LGPL-2.1-or-later
#include "draco/codec/rans.h"

#include "base/byte_writer.h"

namespace lidar::codec {

void RansEncoder::Finish(std::vector<std::uint8_t>* out) {
  std::array<std::uint32_t, 2> states = {kRansLow, kRansLow};
  words_.clear();
  for (std::size_t i = intervals_.size(); i-- > 0;) {
    const std::uint32_t start = intervals_[i] >> 16;
    const std::uint32_t size = intervals_[i] & 0xFFFF;
    std::uint32_t& x = states[i & 1];
    // The largest state that still fits 32 bits after this symbol.
    if (x >= std::uint64_t{size} << (32 - kProbabilityBits)) {
      words_.push_back(static_cast<std::uint16_t>(x));
      x >>= 16;
    }
    x = (x / size << kProbabilityBits) + x % size + start;
  }
  out->reserve(out->size() + 8 + 2 * words_.size());
  ByteWriter writer(out);
  writer.Le32(states[0]);
  writer.Le32(states[1]);
  for (std::size_t i = words_.size(); i-- > 0;) writer.Le16(words_[i]);
}

RansDecoder::RansDecoder(ByteView bytes) {
  ByteReader reader(bytes);
  states_[0] = reader.Le32();
  states_[1] = reader.Le32();
  overrun_ = !reader.ok();
  const ByteView words = reader.Rest();
  position_ = words.begin();
  end_ = words.end();
}

}  // namespace lidar::codec
