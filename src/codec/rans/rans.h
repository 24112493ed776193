// SPDX-License-Identifier: LGPL-2.1-or-later
// An entropy coder: four interleaved rANS states for symbols and the plain bits after them.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/codec/rans/nibble_model.h"

namespace lidar::codec {

/// J. Duda, "Asymmetric numeral systems" (2013), with states of 56 bits, refilled by 32 bits at a
/// time. Four independent chains of symbols, the lanes, have a state each, so that a processor
/// works on all of them at once.
constexpr unsigned kRansLanes = 4;
constexpr unsigned kRansLowBits = 24;
constexpr std::uint64_t kRansLow = std::uint64_t{1} << kRansLowBits;
constexpr unsigned kRansWordBits = 32;
constexpr unsigned kRansStateBytes = (kRansLowBits + kRansWordBits) / 8;
/// Fewest bytes of a written state; the most are kRansStateBytes. An unused lane writes no bytes.
constexpr unsigned kRansShortestState = kRansStateBytes - 2;
/// Most bits that a state of kRansLow can give: with a symbol, and without one.
constexpr unsigned kMaxJointBits = kRansLowBits - kProbabilityBits;
constexpr unsigned kMaxPlainBits = kRansLowBits;

/// Collects symbols and bits in the order of decoding; Finish() codes them backwards.
class RansEncoder {
 private:
  struct Piece {
    Interval interval;
    std::uint32_t bits;  // 24 bits, their count in 6, the lane in 2
  };

 public:
  /// Starts a stream of at most `pieces` calls of Put() and PutBits().
  void Start(std::size_t pieces) {
    if (pieces_.size() < pieces) pieces_.resize(pieces);
    next_ = pieces_.data();
  }
  /// Appends the stream to `out`.
  void Finish(std::vector<std::uint8_t>* out);

  /// Writes to an encoder until it goes out of scope; only one Writer at a time.
  class Writer {
   public:
    explicit Writer(RansEncoder* encoder) : encoder_(encoder), next_(encoder->next_) {}
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;
    ~Writer() { encoder_->next_ = next_; }

    /// Adds a symbol, and the low `count` <= kMaxJointBits of `bits`, whose other bits are 0.
    template <int kHaste = 0>
    [[gnu::always_inline]] void Put(unsigned lane, unsigned symbol, NibbleModel* model,
                                    std::uint32_t bits = 0, unsigned count = 0) {
      *next_++ = {model->IntervalOf(symbol), bits << 8 | count << 2 | lane};
      model->Update<kHaste>(symbol);
    }
    /// The same by the mean of `models`.
    [[gnu::always_inline]] void Put(unsigned lane, unsigned symbol, const BlendedModels& models,
                                    std::uint32_t bits = 0, unsigned count = 0) {
      *next_++ = {NibbleModel::BlendedInterval(models, symbol), bits << 8 | count << 2 | lane};
      for (NibbleModel* model : models) model->Update<kBlendedHaste>(symbol);
    }
    /// Adds the symbol of an interval.
    void Put(unsigned lane, Interval interval) { *next_++ = {interval, lane}; }
    /// Adds the low `count` <= kMaxPlainBits of `bits`, whose other bits are 0.
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

/// Copies are cheap, so a loop uses a copy of its own, which can live in registers.
class RansDecoder {
 public:
  /// `padded` keeps the words, with room for `ahead` calls of GetBits() past the end. Callers check
  /// overran() at least once in `ahead` calls.
  RansDecoder(ByteView bytes, std::size_t ahead, std::vector<std::uint8_t>* padded);

  /// Returns true if bytes past the end were read: the stream is damaged, and callers must stop.
  bool overran() const { return position_ > end_; }

  /// The next call must be GetBits() of the same lane, with a count of 0 if no bits follow.
  template <int kHaste = 0>
  unsigned Get(unsigned lane, NibbleModel* model) {
    const unsigned symbol = Take(lane, *model);
    model->Update<kHaste>(symbol);
    return symbol;
  }
  /// The same by the mean of `models`.
  [[gnu::always_inline]] unsigned Get(unsigned lane, const BlendedModels& models) {
    const unsigned symbol = Take(lane, NibbleModel::Blend(models));
    for (NibbleModel* model : models) model->Update<kBlendedHaste>(symbol);
    return symbol;
  }
  /// Takes symbol 0, of this interval, and no bits. Returns false, with nothing taken, if another
  /// symbol follows.
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
  /// `mask` has `count` ones.
  std::uint32_t GetBits(unsigned lane, unsigned count, std::uint32_t mask) {
    std::uint64_t x = states_[lane];
    const auto bits = static_cast<std::uint32_t>(x) & mask;
    x >>= count;
    // A state in ten needs a refill, so a jump would be mispredicted. States are below 2^63.
    const std::uint64_t refill = (x - kRansLow) >> 63;
    states_[lane] = x << (kRansWordBits * refill) | (LoadWord() & (0 - refill));
    position_ += sizeof(std::uint32_t) * refill;
    return bits;
  }
  /// Returns true if the states are back at the encoder's first ones and each word was used. A
  /// damaged stream hardly ever passes.
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

/// A row of pieces is cut into lanes of nearly the same length, coded in turns: the first piece of
/// each lane, the second of each, and so on. A short row is one lane.
struct RowLanes {
  explicit RowLanes(std::size_t count) : all(count) {
    lanes = count >= kShortestLane * kRansLanes ? kRansLanes : 1;
    turns = count / lanes;
    rest = count % lanes;
  }
  /// Lanes before `rest` have one piece more than `turns`.
  std::size_t Start(std::size_t lane) const { return lane * turns + (lane < rest ? lane : rest); }

  static constexpr std::size_t kShortestLane = 64;
  std::size_t all;
  std::size_t lanes;
  std::size_t turns;
  std::size_t rest;
};

/// Calls code(lane, index) for all pieces of a row, in the order of coding.
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
