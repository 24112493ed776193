// SPDX-License-Identifier: LGPL-2.1-or-later
// An entropy coder with four interleaved rANS states. It codes symbols, and plain bits that may
// follow a symbol.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/codec/rans/nibble_model.h"

namespace lidar::codec {

/// The coder is that of J. Duda, "Asymmetric numeral systems" (2013). States have 56 bits and are
/// refilled by 32 bits at a time. There are four independent sequences of symbols, called lanes.
/// Each has its own state, so that a processor can work on all lanes at once.
constexpr unsigned kRansLanes = 4;
constexpr unsigned kRansLowBits = 24;
constexpr std::uint64_t kRansLow = std::uint64_t{1} << kRansLowBits;
constexpr unsigned kRansWordBits = 32;
constexpr unsigned kRansStateBytes = (kRansLowBits + kRansWordBits) / 8;
/// The smallest number of bytes of a written state. The largest is kRansStateBytes. The state of an
/// unused lane is not written.
constexpr unsigned kRansShortestState = kRansStateBytes - 2;
/// The largest number of plain bits that can be read at once, even from a state of kRansLow:
/// kMaxJointBits together with a symbol, kMaxPlainBits without a symbol.
constexpr unsigned kMaxJointBits = kRansLowBits - kProbabilityBits;
constexpr unsigned kMaxPlainBits = kRansLowBits;

/// Collects symbols and bits in the order in which they will be decoded. Finish() codes them in
/// reverse order.
class RansEncoder {
 private:
  struct Piece {
    Interval interval;
    std::uint32_t bits;  // from the highest: 24 plain bits, 6 for their count, 2 for the lane
  };

 public:
  /// Starts a stream. At most `pieces` calls of Put() and PutBits() may follow.
  void Start(std::size_t pieces) {
    if (pieces_.size() < pieces) pieces_.resize(pieces);
    next_ = pieces_.data();
  }
  /// Codes what was collected, and appends the stream to `out`.
  void Finish(std::vector<std::uint8_t>* out);

  /// Writes to an encoder. The encoder has what was written as soon as the Writer goes out of
  /// scope. Only one Writer may exist at a time.
  class Writer {
   public:
    explicit Writer(RansEncoder* encoder) : encoder_(encoder), next_(encoder->next_) {}
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;
    ~Writer() { encoder_->next_ = next_; }

    /// Adds a symbol, followed by the lowest `count` bits of `bits`. `count` is at most
    /// kMaxJointBits. The other bits of `bits` must be 0.
    template <int kHaste = 0>
    [[gnu::always_inline]] void Put(unsigned lane, unsigned symbol, NibbleModel* model,
                                    std::uint32_t bits = 0, unsigned count = 0) {
      *next_++ = {model->IntervalOf(symbol), bits << 8 | count << 2 | lane};
      model->Update<kHaste>(symbol);
    }
    /// Adds a symbol and bits, too. The symbol is predicted by the mean of `models`.
    [[gnu::always_inline]] void Put(unsigned lane, unsigned symbol, const BlendedModels& models,
                                    std::uint32_t bits = 0, unsigned count = 0) {
      *next_++ = {NibbleModel::BlendedInterval(models, symbol), bits << 8 | count << 2 | lane};
      for (NibbleModel* model : models) model->Update<kBlendedHaste>(symbol);
    }
    /// Adds a symbol, which has this interval.
    void Put(unsigned lane, Interval interval) { *next_++ = {interval, lane}; }
    /// Adds the lowest `count` bits of `bits`. `count` is at most kMaxPlainBits. The other bits of
    /// `bits` must be 0.
    void PutBits(unsigned lane, std::uint32_t bits, unsigned count) {
      *next_++ = {{0, kProbabilityOne}, bits << 8 | count << 2 | lane};
    }

   private:
    RansEncoder* encoder_;
    Piece* next_;
  };

 private:
  std::vector<Piece> pieces_;
  std::vector<std::uint32_t> words_;
  Piece* next_ = nullptr;
};

/// Decodes what a RansEncoder wrote. A loop should use its own copy of the decoder, because the
/// copy can stay in registers. Copying is cheap.
class RansDecoder {
 public:
  /// Copies `bytes` to `padded`, which must live as long as the decoder. `padded` has room for
  /// `ahead` calls of GetBits() past the end, so callers must check overran() at least once in
  /// `ahead` calls.
  RansDecoder(ByteView bytes, std::size_t ahead, std::vector<std::uint8_t>* padded);

  /// Returns true if bytes past the end were read. The stream is then damaged, and callers must
  /// stop.
  bool overran() const { return position_ > end_; }

  /// Reads a symbol. The next call must be GetBits() of the same lane. If no bits follow the
  /// symbol, its `count` is 0.
  template <int kHaste = 0>
  unsigned Get(unsigned lane, NibbleModel* model) {
    const unsigned symbol = Take(lane, *model);
    model->Update<kHaste>(symbol);
    return symbol;
  }
  /// Reads a symbol, too. The symbol is predicted by the mean of `models`.
  [[gnu::always_inline]] unsigned Get(unsigned lane, const BlendedModels& models) {
    const unsigned symbol = Take(lane, NibbleModel::Blend(models));
    for (NibbleModel* model : models) model->Update<kBlendedHaste>(symbol);
    return symbol;
  }
  /// Reads a symbol 0 without plain bits. `zero` is the interval of symbol 0. If another symbol
  /// follows, reads nothing and returns false.
  [[gnu::always_inline]] bool GetZero(unsigned lane, Interval zero) {
    const std::uint64_t x = states_[lane];
    const auto slot = static_cast<std::uint32_t>(x & (kProbabilityOne - 1));
    if (slot >= zero.size) return false;
    states_[lane] = zero.size * (x >> kProbabilityBits) + slot;
    GetBits(lane, 0);
    return true;
  }
  std::uint32_t GetBits(unsigned lane, unsigned count) {
    return GetBits(lane, count, (1U << count) - 1);
  }
  /// Reads `count` plain bits. `mask` must have `count` ones.
  std::uint32_t GetBits(unsigned lane, unsigned count, std::uint32_t mask) {
    std::uint64_t x = states_[lane];
    const auto bits = static_cast<std::uint32_t>(x) & mask;
    x >>= count;
    // A processor would often mispredict a jump, because about one state in ten needs a refill. The
    // shift gives 1 if x < kRansLow, because states are below 2^63.
    const std::uint64_t refill = (x - kRansLow) >> 63;
    states_[lane] = x << (kRansWordBits * refill) | (LoadWord() & (0 - refill));
    position_ += sizeof(std::uint32_t) * refill;
    return bits;
  }
  /// Returns true if every word was used and the states are those with which the encoder began.
  /// After a damaged stream, this is hardly ever so.
  bool AtEnd() const;

 private:
  void ReadStates();
  [[gnu::always_inline]] unsigned Take(unsigned lane, const NibbleModel& model) {
    const std::uint64_t x = states_[lane];
    const auto slot = static_cast<std::uint32_t>(x & (kProbabilityOne - 1));
    const unsigned symbol = model.Find(slot);
    const Interval i = model.IntervalOf(symbol);
    states_[lane] = i.size * (x >> kProbabilityBits) + slot - i.start;
    return symbol;
  }
  std::uint64_t LoadWord() const {
    return std::uint64_t{position_[0]} | std::uint64_t{position_[1]} << 8 |
           std::uint64_t{position_[2]} << 16 | std::uint64_t{position_[3]} << 24;
  }

  std::array<std::uint64_t, kRansLanes> states_{};
  const std::uint8_t* position_ = nullptr;  // of the next word
  const std::uint8_t* end_ = nullptr;
};

/// A row of pieces, divided into lanes of nearly the same length. The lanes are coded in turns: the
/// first piece of each lane, then the second piece of each lane, and so on. A short row has one
/// lane.
struct RowLanes {
  explicit RowLanes(std::size_t count) : all(count) {
    lanes = count >= kShortestLane * kRansLanes ? kRansLanes : 1;
    turns = count / lanes;
    rest = count % lanes;
  }
  /// Returns the index of the first piece of `lane`. The first `rest` lanes have one piece more
  /// than the others.
  std::size_t Start(std::size_t lane) const { return lane * turns + (lane < rest ? lane : rest); }

  static constexpr std::size_t kShortestLane = 64;
  std::size_t all;
  std::size_t lanes;
  std::size_t turns;
  std::size_t rest;
};

/// Calls code(lane, index) for each piece of a row, in the order of coding.
template <class Code>
[[gnu::always_inline]] inline void ForEachInTurns(const RowLanes& row, Code&& code) {
  if (row.lanes == 1) {
    for (std::size_t i = 0; i < row.all; ++i) code(0, i);
    return;
  }
  static_assert(kRansLanes == 4);
  const std::size_t start[] = {0, row.Start(1), row.Start(2), row.Start(3)};
  for (std::size_t i = 0; i < row.turns; ++i) {
    code(0, i);
    code(1, start[1] + i);
    code(2, start[2] + i);
    code(3, start[3] + i);
  }
  if (row.rest > 0) code(0, row.turns);
  if (row.rest > 1) code(1, start[1] + row.turns);
  if (row.rest > 2) code(2, start[2] + row.turns);
}

}  // namespace lidar::codec
