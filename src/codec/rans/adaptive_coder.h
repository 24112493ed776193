// SPDX-License-Identifier: LGPL-2.1-or-later
// Prediction of a block's integers, and the adaptive rANS coder of the residuals.
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

/// A block without its values: which pixels have returns.
struct BlockShape {
  const AzimuthAlignment& alignment;
  const Mask& mask;
  std::uint32_t columns;
};

/// Writes the columns of the 1s in `count` bytes of `mask`, and returns their number. `columns` has
/// room for kListMargin more than these.
std::size_t ListReturns(const std::uint8_t* mask, std::uint32_t count, std::uint16_t* columns);
constexpr std::size_t kListMargin = 8;

/// Calls code_row(beam, count, first) for each row that has returns. `columns` holds the columns of
/// its `count` returns, and `first` is the index of the first one. Stops, and returns false, if a
/// call returns false.
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
  /// Pieces of RansEncoder that a value may take.
  static constexpr std::size_t kMostPieces = SymbolModel::kMostPieces;

  /// Values are below kMaxBins.
  void Encode(const BlockShape& shape, const IntegerLists& lists, RansEncoder* encoder);
  /// Adds the symbols that Encode() would write.
  void Count(const BlockShape& shape, const IntegerLists& lists, SymbolCounts* values,
             SymbolCounts* levels);
  /// Fills the ranges of `image`, and its intensity unless this is empty. Returns false if the
  /// stream is damaged, or a range is not below kMaxBins.
  bool Decode(const BlockShape& shape, const RangeGrid& grid, RansDecoder* decoder,
              RangeImage* image);

  /// Replaces the values by their residuals, and the other way round. Levels do not change.
  void ToResiduals(const BlockShape& shape, IntegerLists* lists);
  bool FromResiduals(const BlockShape& shape, IntegerLists* lists);

  static constexpr std::uint32_t kMaxBins = 1U << 28;

 private:
  void Reset(const BlockShape& shape);
  template <class CodeRow>
  bool ForEachRow(const BlockShape& shape, CodeRow&& code_row);
  /// Ranges or intensities.
  struct Channel {
    std::uint32_t limit;  // values are below it
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
