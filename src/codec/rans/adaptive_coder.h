// SPDX-License-Identifier: LGPL-2.1-or-later
// Codes the integers of a block: predicts each integer, and codes the residuals by rANS symbols
// with adaptive models.
#pragma once
#include <cstdint>
#include <vector>

#include "src/cloud/range_grid.h"
#include "src/codec/integer_coder.h"
#include "src/codec/range_image.h"
#include "src/codec/rans/mask_coder.h"
#include "src/codec/rans/predictor.h"
#include "src/codec/rans/symbol_model.h"

namespace lidar::codec {

/// A block without its values: which of its pixels have returns.
struct BlockShape {
  const AzimuthAlignment& alignment;
  const Mask& mask;
  std::uint32_t columns;
};

/// Finds the 1s in the first `count` bytes of `mask`. Writes their columns to `columns` and returns
/// their number. `columns` must have room for kListMargin more entries.
std::size_t ListReturns(const std::uint8_t* mask, std::uint32_t count, std::uint16_t* columns);
constexpr std::size_t kListMargin = 8;

/// Calls code_row(beam, count, first) for each row that has returns. During the call, `columns` has
/// the columns of the row's `count` returns. `first` is the index of the first of these returns in
/// the block. If a call returns false, stops and returns false.
template <class CodeRow>
bool ForEachRowOf(const BlockShape& shape, std::vector<std::uint16_t>* columns,
                  CodeRow&& code_row) {
  columns->resize(shape.columns + kListMargin);
  const std::uint8_t* mask = shape.mask.data();
  std::size_t first = 0;
  for (std::uint32_t beam = 0; beam < shape.alignment.beams(); ++beam, mask += shape.columns) {
    const std::size_t count = ListReturns(mask, shape.columns, columns->data());
    if (count == 0) continue;
    if (!code_row(beam, count, first)) return false;
    first += count;
  }
  return true;
}

class AdaptiveCoder {
 public:
  /// The largest number of pieces that a value adds to a RansEncoder.
  static constexpr std::size_t kMostPieces = SymbolModel::kMostPieces;

  /// Encodes `lists`. The values must be below kMaxBins.
  void Encode(const BlockShape& shape, const IntegerLists& lists, RansEncoder* encoder);
  /// Counts the symbols that Encode() would write, and adds the counts to `values` and `levels`.
  void Count(const BlockShape& shape, const IntegerLists& lists, SymbolCounts* values,
             SymbolCounts* levels);
  /// Fills the ranges of `image`, and its intensity unless image->intensity is empty. Returns false
  /// if the stream is damaged, or if a value is not below kMaxBins.
  bool Decode(const BlockShape& shape, const RangeGrid& grid, RansDecoder* decoder,
              RangeImage* image);

  /// ToResiduals() replaces the values by their residuals. FromResiduals() replaces residuals by
  /// the values. Levels do not change.
  void ToResiduals(const BlockShape& shape, IntegerLists* lists);
  bool FromResiduals(const BlockShape& shape, IntegerLists* lists);

  static constexpr std::uint32_t kMaxBins = 1U << 28;

 private:
  void Reset(const BlockShape& shape);
  template <class CodeRow>
  bool ForEachRow(const BlockShape& shape, CodeRow&& code_row);
  /// A list of a block: the bins of the ranges, or the levels of the intensities.
  struct Channel {
    std::uint32_t limit;  // all values are below this limit
    RowPredictor predictor = {};
    SymbolModel model = {};
  };
  bool DecodeRow(std::uint32_t beam, const RowReturns& row, RansDecoder* decoder, Channel* channel);

  Channel values_{kMaxBins};
  Channel levels_{256};
  std::vector<std::uint16_t> columns_;
  std::vector<std::int32_t> ranges_;
};

}  // namespace lidar::codec
