// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/rans/adaptive_coder.h"

#include <algorithm>
#include <cstring>

#include "src/codec/rans/initial_models.h"

namespace lidar::codec {
namespace {

/// Returns the residual of `value`, with the sign changed if the prediction is mirrored.
Residual ResidualOf(std::int32_t value, const Prediction& p) {
  const std::int32_t difference = value - p.value;
  const std::int32_t sign = difference >> 31;
  return {(difference ^ sign) - sign, sign ^ p.mirror};
}

Coded ValueOf(const Residual& residual, const Prediction& p) {
  const std::int32_t sign = residual.sign ^ p.mirror;
  return {Sum(p.value, Difference(residual.magnitude ^ sign, sign)), residual.magnitude};
}

}  // namespace

std::size_t ListReturns(const std::uint8_t* mask, std::uint32_t count, std::uint16_t* columns) {
  constexpr std::uint32_t kAtOnce = 8;
  std::uint16_t* next = columns;
  for (std::uint32_t first = 0; first < count; first += kAtOnce) {
    std::uint64_t eight = 0;
    const std::uint32_t here = std::min(kAtOnce, count - first);
    if (here == kAtOnce) std::memcpy(&eight, mask + first, sizeof eight);
    if (eight == 0x0101010101010101U) {
      for (std::uint32_t i = 0; i < kAtOnce; ++i) next[i] = static_cast<std::uint16_t>(first + i);
      next += kAtOnce;
    } else {
      for (std::uint32_t i = 0; i < here; ++i) {
        *next = static_cast<std::uint16_t>(first + i);
        next += mask[first + i];
      }
    }
  }
  return static_cast<std::size_t>(next - columns);
}

void AdaptiveCoder::Reset(const BlockShape& shape) {
  values_.predictor.Reset(shape.alignment, shape.columns);
  levels_.predictor.Reset(shape.alignment, shape.columns);
  values_.model.Reset(InitialModelsOfValues());
  levels_.model.Reset(InitialModelsOfLevels());
}

/// Calls code_row(beam, row, first) for each row that has returns. `first` is the index of the
/// row's first return in the block. If a call returns false, stops and returns false.
template <class CodeRow>
bool AdaptiveCoder::ForEachRow(const BlockShape& shape, CodeRow&& code_row) {
  Reset(shape);
  return ForEachRowOf(shape, &columns_,
                      [&](std::uint32_t beam, std::size_t count, std::size_t first) {
                        return code_row(beam, RowReturns{columns_.data(), RowLanes(count)}, first);
                      });
}

void AdaptiveCoder::Encode(const BlockShape& shape, const IntegerLists& lists,
                           RansEncoder* encoder) {
  ForEachRow(shape, [&](std::uint32_t beam, const RowReturns& row, std::size_t first) {
    const auto encode = [&](const auto* values, Channel* channel) {
      RansEncoder::Writer writer(encoder);
      channel->predictor.CodeRow(beam, row, kMaxBins,
                                 [&](unsigned lane, std::size_t i, const Prediction& p) {
                                   const std::int32_t value = values[i];
                                   const Residual residual = ResidualOf(value, p);
                                   channel->model.Encode(residual, p.context, lane, &writer);
                                   return Coded{value, residual.magnitude};
                                 });
    };
    encode(&lists.values[first], &values_);
    if (!lists.levels.empty()) encode(&lists.levels[first], &levels_);
    return true;
  });
}

void AdaptiveCoder::Count(const BlockShape& shape, const IntegerLists& lists, SymbolCounts* values,
                          SymbolCounts* levels) {
  ForEachRow(shape, [&](std::uint32_t beam, const RowReturns& row, std::size_t first) {
    const auto count = [&](const auto* list, SymbolCounts* counts, Channel* channel) {
      channel->predictor.CodeRow(beam, row, kMaxBins,
                                 [&](unsigned, std::size_t i, const Prediction& p) {
                                   const std::int32_t value = list[i];
                                   const Residual residual = ResidualOf(value, p);
                                   SymbolModel::Count(residual, p.context, counts);
                                   return Coded{value, residual.magnitude};
                                 });
    };
    count(&lists.values[first], values, &values_);
    if (!lists.levels.empty()) count(&lists.levels[first], levels, &levels_);
    return true;
  });
}

bool AdaptiveCoder::DecodeRow(std::uint32_t beam, const RowReturns& row, RansDecoder* decoder,
                              Channel* channel) {
  RansDecoder local = *decoder;
  const bool within = channel->predictor.CodeRow(
      beam, row, channel->limit, [&](unsigned lane, std::size_t, const Prediction& p) {
        return ValueOf(channel->model.Decode(p.context, lane, &local), p);
      });
  *decoder = local;
  return within && !local.overran();
}

bool AdaptiveCoder::Decode(const BlockShape& shape, const RangeGrid& grid, RansDecoder* decoder,
                           RangeImage* image) {
  image->ranges.assign(image->size(), 0);
  return ForEachRow(shape, [&](std::uint32_t beam, const RowReturns& row, std::size_t) {
    if (!DecodeRow(beam, row, decoder, &values_)) return false;
    const std::size_t first = std::size_t{beam} * shape.columns;
    const std::size_t count = row.lanes.all;
    ranges_.assign(values_.predictor.values(), values_.predictor.values() + count);
    if (!grid.ToRanges(&ranges_)) return false;
    for (std::size_t i = 0; i < count; ++i)
      image->ranges[first + row.columns[i]] = static_cast<std::uint32_t>(ranges_[i]);
    if (image->intensity.empty()) return true;
    if (!DecodeRow(beam, row, decoder, &levels_)) return false;
    const std::int32_t* levels = levels_.predictor.values();
    for (std::size_t i = 0; i < count; ++i)
      image->intensity[first + row.columns[i]] = static_cast<std::uint8_t>(levels[i]);
    return true;
  });
}

void AdaptiveCoder::ToResiduals(const BlockShape& shape, IntegerLists* lists) {
  ForEachRow(shape, [&](std::uint32_t beam, const RowReturns& row, std::size_t first) {
    std::int32_t* values = &lists->values[first];
    return values_.predictor.CodeRow(
        beam, row, kMaxBins, [&](unsigned, std::size_t i, const Prediction& p) {
          const std::int32_t value = values[i];
          const Residual residual = ResidualOf(value, p);
          values[i] = (residual.magnitude ^ residual.sign) - residual.sign;
          return Coded{value, residual.magnitude};
        });
  });
}

bool AdaptiveCoder::FromResiduals(const BlockShape& shape, IntegerLists* lists) {
  return ForEachRow(shape, [&](std::uint32_t beam, const RowReturns& row, std::size_t first) {
    std::int32_t* values = &lists->values[first];
    return values_.predictor.CodeRow(
        beam, row, kMaxBins, [&](unsigned, std::size_t i, const Prediction& p) {
          const std::int32_t sign = values[i] >> 31;
          const Coded coded = ValueOf({Difference(values[i] ^ sign, sign), sign}, p);
          values[i] = coded.value;
          return coded;
        });
  });
}

}  // namespace lidar::codec
