// SPDX-License-Identifier: LGPL-2.1-or-later
// An entropy coder: two interleaved 32-bit rANS states for symbols, and plain bits beside them.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "base/byte_reader.h"
#include "draco/codec/nibble_model.h"

namespace lidar::codec {

/// J. Duda, "Asymmetric numeral systems" (2013), in the form of F. Giesen's "rans_word": a state
/// in kRansLow .. 2^32 - 1, refilled by 16 bits at a time. Symbols alternate between two states,
/// which lets a processor work on two at once. Words are read from the front of the stream, plain
/// bits from its back, and an undamaged stream ends where they meet.
constexpr std::uint32_t kRansLow = 1U << 16;
constexpr unsigned kMaxPlainBits = 28;

/// Collects symbols and bits in the order in which they will be decoded; Finish() codes the
/// symbols backwards.
class RansEncoder {
 public:
  /// Starts a stream of at most `symbols` symbols and as many pieces of bits.
  void Start(std::size_t symbols) {
    if (intervals_.size() < symbols) intervals_.resize(symbols);
    if (bits_.size() < 4 * symbols + 8) bits_.resize(4 * symbols + 8);
    next_interval_ = intervals_.data();
    next_bits_ = bits_.data();
    held_ = 0;
    held_count_ = 0;
  }
  void Put(unsigned symbol, NibbleModel* model) {
    *next_interval_++ = model->IntervalOf(symbol);
    model->Update(symbol);
  }
  /// The low `count` <= kMaxPlainBits of `value`.
  void PutBits(std::uint32_t value, unsigned count) {
    held_ |= std::uint64_t{value & ((1U << count) - 1)} << held_count_;
    held_count_ += count;
    if (held_count_ < 32) return;
    const auto low = static_cast<std::uint32_t>(held_);
    std::memcpy(next_bits_, &low, sizeof low);
    next_bits_ += sizeof low;
    held_ >>= 32;
    held_count_ -= 32;
  }
  /// Appends the stream to `out`.
  void Finish(std::vector<std::uint8_t>* out);

 private:
  std::vector<Interval> intervals_;
  std::vector<std::uint8_t> bits_;
  std::vector<std::uint16_t> words_;
  Interval* next_interval_ = nullptr;
  std::uint8_t* next_bits_ = nullptr;
  std::uint64_t held_ = 0;
  unsigned held_count_ = 0;
};

class RansDecoder {
 public:
  explicit RansDecoder(ByteView bytes);

  unsigned Get(NibbleModel* model) {
    const std::uint32_t slot = states_[0] & (kProbabilityOne - 1);
    const unsigned symbol = model->Find(slot);
    const Interval i = model->IntervalOf(symbol);
    std::uint32_t x = i.size * (states_[0] >> kProbabilityBits) + slot - i.start;
    if (x < kRansLow) x = x << 16 | NextWord();
    states_[0] = states_[1];
    states_[1] = x;
    model->Update(symbol);
    return symbol;
  }
  std::uint32_t GetBits(unsigned count) {
    if (held_count_ < kMaxPlainBits) RefillBits();
    const auto value = static_cast<std::uint32_t>(held_) & ((1U << count) - 1);
    held_ >>= count;
    held_count_ -= count;
    return value;
  }
  /// True where all symbols were read and the stream was one of RansEncoder: the states are back
  /// where the encoder began and every byte was used. A damaged stream hardly ever passes.
  bool AtEnd() const;

 private:
  /// Zero past the end, and AtEnd() is false for good.
  std::uint32_t NextWord() {
    if (end_ - position_ < 2) {
      overrun_ = true;
      return 0;
    }
    const std::uint32_t word =
        static_cast<std::uint32_t>(position_[0]) | static_cast<std::uint32_t>(position_[1]) << 8;
    position_ += 2;
    return word;
  }
  /// May take words for bits where the bits end; AtEnd() knows.
  void RefillBits() {
    if (back_ - begin_ < 4) {
      RefillLastBits();
      return;
    }
    back_ -= 4;
    held_ |= std::uint64_t{static_cast<std::uint32_t>(back_[3]) |
                           static_cast<std::uint32_t>(back_[2]) << 8 |
                           static_cast<std::uint32_t>(back_[1]) << 16 |
                           static_cast<std::uint32_t>(back_[0]) << 24}
             << held_count_;
    held_count_ += 32;
  }
  void RefillLastBits();

  std::array<std::uint32_t, 2> states_{};
  std::uint64_t held_ = 0;
  unsigned held_count_ = 0;
  const std::uint8_t* begin_ = nullptr;     // of the words
  const std::uint8_t* position_ = nullptr;  // of the next word
  const std::uint8_t* end_ = nullptr;
  const std::uint8_t* back_ = nullptr;  // behind the next bits
  std::ptrdiff_t missing_ = 0;          // minus the zero bytes made up past the end
  bool overrun_ = false;
};

}  // namespace lidar::codec
