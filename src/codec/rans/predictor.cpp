// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/rans/predictor.h"

namespace lidar::codec {

void RowPredictor::Reset(const AzimuthAlignment& alignment, std::uint32_t columns) {
  above_.Reset(alignment, columns, {});
  latest_ = 0;
  row_.resize(columns);
  values_.resize(columns);
}

bool RowPredictor::Prepare(std::uint32_t beam, const RowReturns& row) {
  const Known* above = above_.At(beam);
  const std::size_t count = row.lanes.all;
  std::size_t first = 0;
  while (first < count && above[row.columns[first]].value == kUnknown) ++first;
  if (first == count) return false;
  // If the value above a return is unknown, the value above the previous return of the row is used.
  std::int32_t last = above[row.columns[first]].value;
  for (std::size_t i = 0; i < count; ++i) {
    const Known* at = above + row.columns[i];
    const std::int32_t n = at[0].value == kUnknown ? last : at[0].value;
    const std::int32_t ne = at[1].value == kUnknown ? n : at[1].value;
    row_[i].north = n;
    row_[i].gradient = n - last;
    row_[i].uneven = std::abs(n - last) + std::abs(ne - n) + 2 * at[0].error;
    last = n;
  }
  for (std::size_t lane = 1; lane < row.lanes.lanes; ++lane) {
    Return& start = row_[row.lanes.Start(lane)];
    start.uneven -= std::abs(start.gradient);
    start.gradient = 0;
  }
  return true;
}

bool RowPredictor::Keep(std::uint32_t beam, const RowReturns& row, std::uint32_t limit) {
  const std::size_t count = row.lanes.all;
  Known* above = above_.At(beam);
  std::uint32_t all_bits = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Return& at = row_[i];
    above[row.columns[i]] = {at.value, at.error};
    values_[i] = at.value;
    all_bits |= static_cast<std::uint32_t>(at.value);
  }
  latest_ = values_[count - 1];
  above_.CloseTurn(beam);
  return all_bits < limit;
}

}  // namespace lidar::codec
