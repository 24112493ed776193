// SPDX-License-Identifier: LGPL-2.1-or-later
#include "draco/codec/rans.h"

#include <algorithm>

#include "base/byte_writer.h"

namespace lidar::codec {

void RansEncoder::Finish(std::vector<std::uint8_t>* out) {
  const auto symbols = static_cast<std::size_t>(next_interval_ - intervals_.data());
  std::array<std::uint32_t, 2> states = {kRansLow, kRansLow};
  if (words_.size() < symbols) words_.resize(symbols);
  // At most one word a symbol. They are decoded in the opposite order, so they grow downwards.
  std::uint16_t* const words_end = words_.data() + words_.size();
  std::uint16_t* word = words_end;
  for (std::size_t i = symbols; i-- > 0;) {
    const std::uint32_t size = intervals_[i].size;
    std::uint32_t& x = states[i & 1];
    // The largest state that still fits 32 bits after this symbol.
    if (x >= std::uint64_t{size} << (32 - kProbabilityBits)) {
      *--word = static_cast<std::uint16_t>(x);
      x >>= 16;
    }
    x = (x / size << kProbabilityBits) + x % size + intervals_[i].start;
  }
  const unsigned tail = (held_count_ + 7) / 8;
  const auto bit_bytes = static_cast<std::size_t>(next_bits_ - bits_.data());
  out->reserve(out->size() + 8 + 2 * symbols + bit_bytes + tail);
  ByteWriter writer(out);
  writer.Le32(states[0]);
  writer.Le32(states[1]);
  for (; word != words_end; ++word) writer.Le16(*word);
  for (unsigned i = tail; i-- > 0;) writer.U8(static_cast<std::uint8_t>(held_ >> (8 * i)));
  out->insert(out->end(), std::make_reverse_iterator(next_bits_),
              std::make_reverse_iterator(bits_.data()));
}

RansDecoder::RansDecoder(ByteView bytes) {
  ByteReader reader(bytes);
  states_[0] = reader.Le32();
  states_[1] = reader.Le32();
  overrun_ = !reader.ok();
  const ByteView rest = reader.Rest();
  begin_ = position_ = rest.begin();
  end_ = back_ = rest.end();
}

/// Zeros past the end, which AtEnd() finds.
void RansDecoder::RefillLastBits() {
  while (held_count_ < kMaxPlainBits) {
    std::uint64_t byte = 0;
    if (back_ != begin_) {
      byte = *--back_;
    } else {
      --missing_;
    }
    held_ |= byte << held_count_;
    held_count_ += 8;
  }
}

bool RansDecoder::AtEnd() const {
  // Whole bytes that were taken but not used are given back; zeros from past the end are among
  // them, or they were used and the stream is damaged.
  const auto unused = static_cast<std::ptrdiff_t>(held_count_ / 8);
  const auto partial = held_ & ((1U << held_count_ % 8) - 1);
  return !overrun_ && position_ - begin_ == back_ - begin_ + unused + missing_ && partial == 0 &&
         states_[0] == kRansLow && states_[1] == kRansLow;
}

}  // namespace lidar::codec
