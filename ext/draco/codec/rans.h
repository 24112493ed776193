// SPDX-License-Identifier: LGPL-2.1-or-later
// An entropy coder: two interleaved 32-bit rANS states that share one stream of 16-bit words.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/byte_reader.h"
#include "draco/codec/nibble_model.h"

namespace lidar::codec {

/// J. Duda, "Asymmetric numeral systems" (2013), in the form of F. Giesen's "rans_word": a state
/// in kRansLow .. 2^32 - 1, refilled by 16 bits at a time. Symbols alternate between two states,
/// which lets a processor work on two at once.
constexpr std::uint32_t kRansLow = 1U << 16;
constexpr unsigned kMaxRawBits = 12;

/// Collects intervals in the order in which they will be decoded; Finish() codes them backwards.
class RansEncoder {
 public:
  void Clear() { intervals_.clear(); }
  void Put(Interval i) { intervals_.push_back(static_cast<std::uint32_t>(i.start) << 16 | i.size); }
  void Put(unsigned symbol, NibbleModel* model) {
    Put(model->IntervalOf(symbol));
    model->Update(symbol);
  }
  /// The low `bits` <= kMaxRawBits of `value`, all values being equally likely.
  void PutRaw(std::uint32_t value, unsigned bits) {
    const unsigned shift = kProbabilityBits - bits;
    value &= (1U << bits) - 1;
    Put({static_cast<std::uint16_t>(value << shift), static_cast<std::uint16_t>(1U << shift)});
  }
  std::size_t symbols() const { return intervals_.size(); }
  /// Appends the stream to `out`.
  void Finish(std::vector<std::uint8_t>* out);

 private:
  std::vector<std::uint32_t> intervals_;
  std::vector<std::uint16_t> words_;
};

class RansDecoder {
 public:
  explicit RansDecoder(ByteView bytes);

  unsigned Get(NibbleModel* model) {
    const std::uint32_t slot = states_[0] & (kProbabilityOne - 1);
    const unsigned symbol = model->Find(slot);
    Advance(model->IntervalOf(symbol), slot);
    model->Update(symbol);
    return symbol;
  }
  std::uint32_t GetRaw(unsigned bits) {
    const unsigned shift = kProbabilityBits - bits;
    const std::uint32_t slot = states_[0] & (kProbabilityOne - 1);
    const std::uint32_t value = slot >> shift;
    Advance({static_cast<std::uint16_t>(value << shift), static_cast<std::uint16_t>(1U << shift)},
            slot);
    return value;
  }
  /// True where all symbols were read and the stream was one of RansEncoder: the states are back
  /// where the encoder began and no word is left. A damaged stream passes once in 2^32.
  bool AtEnd() const {
    return !overrun_ && position_ == end_ && states_[0] == kRansLow && states_[1] == kRansLow;
  }

 private:
  void Advance(Interval i, std::uint32_t slot) {
    std::uint32_t x = i.size * (states_[0] >> kProbabilityBits) + slot - i.start;
    if (x < kRansLow) x = x << 16 | NextWord();
    states_[0] = states_[1];
    states_[1] = x;
  }
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

  std::array<std::uint32_t, 2> states_{};
  const std::uint8_t* position_ = nullptr;
  const std::uint8_t* end_ = nullptr;
  bool overrun_ = false;
};

}  // namespace lidar::codec
