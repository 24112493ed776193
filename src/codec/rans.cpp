// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/rans.h"

#include <algorithm>

#include "src/base/byte_writer.h"

namespace lidar::codec {

void RansEncoder::Finish(std::vector<std::uint8_t>* out) {
  const auto pieces = static_cast<std::size_t>(next_ - pieces_.data());
  std::array<std::uint64_t, kRansLanes> states;
  states.fill(kRansLow);
  // At most one word a piece, and one that is written but not kept. They are decoded in the
  // opposite order, so they grow downwards.
  if (words_.size() < pieces + 1) words_.resize(pieces + 1);
  std::uint32_t* const words_end = words_.data() + words_.size();
  std::uint32_t* word = words_end;
  for (std::size_t i = pieces; i-- > 0;) {
    const Piece& piece = pieces_[i];
    const std::uint64_t size = piece.interval.size;
    const unsigned count = piece.bits >> 2 & 63;
    std::uint64_t& state = states[piece.bits & 3];
    std::uint64_t x = state;
    // Whether the state would outgrow its bits with this piece.
    const bool full = x >= size << (kRansLowBits + kRansWordBits - kProbabilityBits - count);
    word[-1] = static_cast<std::uint32_t>(x);
    word -= full ? 1 : 0;
    x >>= full ? kRansWordBits : 0;
    x = x << count | piece.bits >> 8;
    const std::uint64_t quotient = x / size;
    state = (quotient << kProbabilityBits) + (x - quotient * size) + piece.interval.start;
  }
  const auto words = static_cast<std::size_t>(words_end - word);
  out->reserve(out->size() + kRansLanes * kRansStateBytes + sizeof(std::uint32_t) * words);
  ByteWriter writer(out);
  for (const std::uint64_t state : states)
    for (unsigned i = 0; i < kRansStateBytes; ++i)
      writer.U8(static_cast<std::uint8_t>(state >> (8 * i)));
  for (; word != words_end; ++word) writer.Le32(*word);
}

RansDecoder::RansDecoder(ByteView bytes, std::size_t ahead, std::vector<std::uint8_t>* padded) {
  constexpr std::size_t kStates = kRansLanes * kRansStateBytes;
  constexpr std::size_t kWord = sizeof(std::uint32_t);
  const std::size_t size = std::max(bytes.size, kStates);
  padded->assign(size + (ahead + 2) * kWord, 0);
  if (bytes.size > 0) std::memcpy(padded->data(), bytes.data, bytes.size);
  for (unsigned lane = 0; lane < kRansLanes; ++lane)
    for (unsigned i = 0; i < kRansStateBytes; ++i)
      states_[lane] |= std::uint64_t{(*padded)[lane * kRansStateBytes + i]} << (8 * i);
  position_ = padded->data() + kStates;
  end_ = padded->data() + size;
  if (bytes.size < kStates) ++position_;  // overran() for good
}

bool RansDecoder::AtEnd() const {
  bool home = position_ == end_;
  for (const std::uint64_t state : states_) home = home && state == kRansLow;
  return home;
}

}  // namespace lidar::codec
