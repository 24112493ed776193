// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes the integers of a block by rANS symbols. Each symbol is predicted by a blend of the models
// of four contexts.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "src/codec/rans/adaptive_coder.h"
#include "src/codec/rans/symbol_model.h"

namespace lidar::codec {

/// Codes one list of a block: bins or levels (docs/wire-format.md, "Blended models").
class BlendedChannel {
 public:
  /// The largest number of pieces that a value adds to a RansEncoder.
  static constexpr std::size_t kMostPieces = 5;

  /// All values are below `limit`.
  explicit BlendedChannel(std::int32_t limit) : limit_(limit) {}
  void Reset(const BlockShape& shape, const InitialModels& start);
  /// Encodes `values`, one for each of the `count` returns of a row. `columns` has their columns.
  template <class T>
  void EncodeRow(std::uint32_t beam, const std::uint16_t* columns, std::size_t count,
                 const T* values, RansEncoder* encoder);
  /// Decodes the `values` of a row. `columns` has the columns of its `count` returns. Returns false
  /// if the stream ends too early, or if a value is not below the limit.
  bool DecodeRow(std::uint32_t beam, const std::uint16_t* columns, std::size_t count,
                 std::int32_t* values, RansDecoder* decoder);

 private:
  static constexpr std::int32_t kUnknown = -1;
  static constexpr unsigned kBlended = std::tuple_size_v<BlendedModels>;
  static constexpr unsigned kCandidates = 3;
  /// The number of contexts of each kind.
  static constexpr std::array<std::uint32_t, kBlended> kSizes = {kContexts * 4, 7 * 7 * 7 * 4,
                                                                 11 * 11 * 11, 15 * 8 * 4 * 2};
  /// The newest values of the beams above, at one azimuth.
  struct Known {
    std::int32_t value = kUnknown;
    std::int32_t before = kUnknown;  // the value before `value`, of a higher beam
    std::int32_t residual = 0;       // of `value`, -3 to 3
  };
  /// The state of a row after the values coded so far.
  struct Row {
    std::int32_t west = kUnknown;
    std::int32_t west2 = kUnknown;
    std::int32_t residual = 0;      // of the last value, -3 to 3
    std::int32_t other = kUnknown;  // value to the left of the last jump
    std::uint32_t next = 0;         // column after the last value
  };
  /// The prediction of a value, made before the value is coded.
  struct View {
    std::int32_t median;
    std::int32_t mirror;  // 1 or -1
    std::int32_t west;
    std::array<std::int32_t, kCandidates> candidates;  // values near which a jump may end
    BlendedModels models;
  };
  /// Returns a bit for each candidate. It is 1 if the candidate lies in the direction `sense` and
  /// is not much nearer than the shortest jump.
  static unsigned Behind(const View& view, std::int32_t sense);
  void StartRow(std::uint32_t beam);
  View Look(std::uint32_t column);
  void Keep(const View& view, std::int32_t value, std::uint32_t column);
  void EndRow(std::uint32_t beam);
  void EncodeJump(const View& view, std::int32_t value, std::int32_t sense, unsigned lane,
                  RansEncoder::Writer* writer);
  std::int32_t DecodeJump(const View& view, std::int32_t sense, unsigned lane,
                          RansDecoder* decoder);

  std::int32_t limit_;
  AlignedRow<Known> above_;
  std::vector<std::int32_t> north_;  // [i + 1]: the value above pixel i
  Known* known_ = nullptr;           // at the azimuth of the row's first pixel
  bool blind_ = true;                // the row has no value above it
  std::int32_t latest_ = 0;          // value of the latest return
  std::uint32_t columns_ = 0;
  Row row_;
  std::array<std::vector<NibbleModel>, kBlended> models_;
  std::array<NibbleModel, 1U << kCandidates> choices_;
  std::array<NibbleModel, kCandidates> distances_;  // of a value from a candidate
  LongModel longs_;
};

class BlendedCoder {
 public:
  /// The largest number of pieces that a value adds to a RansEncoder.
  static constexpr std::size_t kMostPieces = BlendedChannel::kMostPieces;

  /// Encode() and Decode() do the same as those of AdaptiveCoder, in fewer bits and more time.
  void Encode(const BlockShape& shape, const IntegerLists& lists, RansEncoder* encoder);
  bool Decode(const BlockShape& shape, const RangeGrid& grid, RansDecoder* decoder,
              RangeImage* image);

 private:
  void Reset(const BlockShape& shape, bool with_levels);

  BlendedChannel values_{AdaptiveCoder::kMaxBins};
  BlendedChannel levels_{256};
  std::vector<std::uint16_t> columns_;
  std::vector<std::int32_t> row_;
};

}  // namespace lidar::codec
