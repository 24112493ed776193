// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/rans/rans.h"

#include <algorithm>

#include "src/base/byte_writer.h"

namespace lidar::codec {
namespace {

/// Returns the code of a state's size in a stream. BytesOf() converts it to a number of bytes.
unsigned SizeCode(std::uint64_t state) {
  unsigned bytes = kRansShortestState;
  while (bytes < kRansStateBytes && state >> (8 * bytes) != 0) ++bytes;
  return state == kRansLow ? 0 : bytes - kRansShortestState + 1;
}
unsigned BytesOf(unsigned size_code) {
  return size_code == 0 ? 0 : size_code + kRansShortestState - 1;
}

}  // namespace

void RansEncoder::Finish(std::vector<std::uint8_t>* out) {
  const auto pieces = static_cast<std::size_t>(next_ - pieces_.data());
  std::array<std::uint64_t, kRansLanes> states;
  states.fill(kRansLow);
  // A piece adds at most one word. The loop writes one word more, which is not used. Words are
  // stored backwards from the end, because decoding reverses their order.
  if (words_.size() < pieces + 1) words_.resize(pieces + 1);
  std::uint32_t* const words_end = words_.data() + words_.size();
  std::uint32_t* word = words_end;
  for (std::size_t i = pieces; i-- > 0;) {
    const Piece& piece = pieces_[i];
    const std::uint64_t size = piece.interval.size;
    const unsigned count = piece.bits >> 2 & 63;
    std::uint64_t& state = states[piece.bits & 3];
    std::uint64_t x = state;
    // True if the state would have too many bits after this piece.
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
  unsigned sizes = 0;
  for (unsigned lane = 0; lane < kRansLanes; ++lane) sizes |= SizeCode(states[lane]) << (2 * lane);
  writer.U8(static_cast<std::uint8_t>(sizes));
  for (const std::uint64_t state : states)
    for (unsigned i = 0; i < BytesOf(SizeCode(state)); ++i)
      writer.U8(static_cast<std::uint8_t>(state >> (8 * i)));
  for (; word != words_end; ++word) writer.Le32(*word);
}

RansDecoder::RansDecoder(ByteView bytes, std::size_t ahead, std::vector<std::uint8_t>* padded) {
  // Zeros follow the bytes: for the states, if the stream is too short for them, and for words that
  // are read past the end.
  constexpr std::size_t kStates = 1 + kRansLanes * kRansStateBytes;
  padded->assign(bytes.size + kStates + (ahead + 2) * sizeof(std::uint32_t), 0);
  if (bytes.size > 0) std::memcpy(padded->data(), bytes.data, bytes.size);
  position_ = padded->data();
  end_ = padded->data() + bytes.size;
  ReadStates();
}

void RansDecoder::ReadStates() {
  const unsigned sizes = *position_++;
  for (unsigned lane = 0; lane < kRansLanes; ++lane) {
    const unsigned bytes = BytesOf(sizes >> (2 * lane) & 3);
    states_[lane] = bytes == 0 ? kRansLow : 0;
    for (unsigned i = 0; i < bytes; ++i) states_[lane] |= std::uint64_t{*position_++} << (8 * i);
  }
}

bool RansDecoder::AtEnd() const {
  bool home = position_ == end_;
  for (const std::uint64_t state : states_) home = home && state == kRansLow;
  return home;
}

}  // namespace lidar::codec
