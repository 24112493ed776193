// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/rans/blended_coder.h"

#include <algorithm>
#include <cstdlib>

#include "src/codec/mixing/neighbours.h"

namespace lidar::codec {
namespace {

using mixing::OffsetClass;
using mixing::PhaseClass;

std::uint32_t OffsetOf(std::int32_t difference, std::int32_t mirror) {
  constexpr std::int32_t kMost = 16;
  return OffsetClass(std::clamp(difference, -kMost, kMost) * mixing::kStep * mirror);
}

}  // namespace

void BlendedChannel::Reset(const BlockShape& shape, const InitialModels& start) {
  above_.Reset(shape.alignment, shape.columns, {});
  north_.assign(shape.columns + 2, 0);
  columns_ = shape.columns;
  latest_ = 0;
  for (unsigned k = 0; k < kBlended; ++k) models_[k].assign(kSizes[k], NibbleModel());
  for (std::uint32_t i = 0; i < kSizes[0]; ++i) models_[0][i] = start.residuals[i / 4];
  choices_.fill(NibbleModel());
  distances_.fill(start.residuals[kContexts - 1]);
  longs_.Reset(start.longs);
}

void BlendedChannel::StartRow(std::uint32_t beam) {
  row_ = {};
  known_ = above_.At(beam);
  const Known* first = known_ - 1;
  const Known* const end = known_ + columns_ + 1;
  while (first != end && first->value == kUnknown) ++first;
  blind_ = first == end;
  if (blind_) return;
  std::int32_t last = first->value;
  for (std::uint32_t i = 0; i < columns_ + 2; ++i) {
    const std::int32_t value = known_[static_cast<std::ptrdiff_t>(i) - 1].value;
    last = value == kUnknown ? last : value;
    north_[i] = last;
  }
}

[[gnu::always_inline]] inline BlendedChannel::View BlendedChannel::Look(std::uint32_t column) {
  const Known& at = known_[column];
  View v;
  const bool starts = row_.west == kUnknown;
  std::int32_t n;
  std::int32_t nw;
  std::int32_t ne;
  if (blind_) {
    n = nw = ne = starts ? latest_ : row_.west;
  } else {
    n = north_[column + 1];
    nw = starts ? n : north_[column];
    ne = north_[column + 2];
  }
  const std::int32_t w = v.west = starts ? n : row_.west;
  const std::int32_t ww = row_.west2 == kUnknown ? w : row_.west2;
  const std::int32_t nn = at.before == kUnknown ? n : at.before;
  const std::int32_t gradient = w + n - nw;
  const std::int32_t median = std::max(std::min(w, n), std::min(std::max(w, n), gradient));
  const std::int32_t mirror = n < w ? -1 : 1;
  const auto uneven =
      static_cast<std::uint32_t>(std::abs(w - n) + std::abs(n - nw) + std::abs(ne - n) +
                                 2 * (std::abs(row_.residual) + std::abs(at.residual)));
  const std::uint32_t context =
      detail::kContextTable.contexts[std::min(uneven, detail::ContextTable::kMost + 0U)];
  const std::uint32_t event = w == n ? 3 : median == w ? 1 : median == n ? 2 : 0;
  const std::uint32_t gap = column - row_.next;
  const std::uint32_t gap_class = gap == 0 ? 0 : gap < 3 ? 1 : gap < 8 ? 2 : 3;
  const std::int32_t phase = std::clamp((w + n + ne + gradient - 4 * median) * mirror, -16, 16);
  const auto residual = [&](std::int32_t r) { return mixing::ResidualClass(r, mirror); };
  const auto offset = [&](std::int32_t value) { return OffsetOf(value - median, mirror); };
  const std::uint32_t was_zero = !starts && row_.residual == 0 ? 1 : 0;
  v.models = {&models_[0][context * 4 + gap_class],
              &models_[1][((residual(row_.residual) * 7 + residual(at.residual)) * 7 +
                           residual(known_[column + 1].residual)) *
                              4 +
                          event],
              &models_[2][(offset(ne) * 11 + offset(nn)) * 11 + offset(ww)],
              &models_[3][((PhaseClass(phase * 4) * 8 + context / 2) * 4 + event) * 2 + was_zero]};
  for (unsigned k = 1; k < kBlended; ++k) v.models[k]->InheritOnce(*v.models[0]);
  v.median = median;
  v.mirror = mirror;
  v.candidates = {row_.other == kUnknown ? ne : row_.other, ne, nw};
  return v;
}

[[gnu::always_inline]] inline void BlendedChannel::Keep(const View& view, std::int32_t value,
                                                        std::uint32_t column) {
  const std::int32_t difference = value - view.median;
  if (std::abs(difference) > 3) row_.other = view.west;
  Known& at = known_[column];
  row_.residual = at.residual = std::clamp(difference, -3, 3);
  at.before = at.value;
  at.value = value;
  row_.west2 = row_.west;
  row_.west = latest_ = value;
  row_.next = column + 1;
}

void BlendedChannel::EndRow(std::uint32_t beam) { above_.CloseTurn(beam); }

unsigned BlendedChannel::Behind(const View& view, std::int32_t sense) {
  // The shortest jump is kLongMagnitude. The limit is a little less, because a candidate just below
  // kLongMagnitude still predicts short jumps well.
  constexpr std::int32_t kNearest = 28;
  unsigned behind = 0;
  for (unsigned k = 0; k < kCandidates; ++k)
    if ((view.candidates[k] - view.median) * sense >= kNearest) behind |= 1U << k;
  return behind;
}

void BlendedChannel::EncodeJump(const View& view, std::int32_t value, std::int32_t sense,
                                unsigned lane, RansEncoder::Writer* writer) {
  const std::int32_t rest = (value - view.median) * sense - static_cast<int>(kLongMagnitude);
  const unsigned behind = Behind(view, sense);
  std::int32_t nearest = rest;
  unsigned chosen = kCandidates;
  for (unsigned k = 0; k < kCandidates; ++k) {
    const std::int32_t distance = std::abs(value - view.candidates[k]);
    if ((behind >> k & 1) == 0 || distance >= nearest) continue;
    nearest = distance;
    chosen = k;
  }
  if (behind != 0) writer->Put<kBlendedHaste>(lane, chosen, &choices_[behind]);
  if (chosen == kCandidates) {
    longs_.Encode(static_cast<std::uint32_t>(rest), lane, writer);
    return;
  }
  const std::int32_t off = (value - view.candidates[chosen]) * sense;
  const ClassedResidual coded(static_cast<std::uint32_t>(nearest), off < 0);
  writer->Put<kBlendedHaste>(lane, coded.symbol, &distances_[chosen], coded.low, coded.bits);
  if (coded.is_long) longs_.Encode(coded.rest, lane, writer);
}

std::int32_t BlendedChannel::DecodeJump(const View& view, std::int32_t sense, unsigned lane,
                                        RansDecoder* decoder) {
  const unsigned behind = Behind(view, sense);
  unsigned chosen = kCandidates;
  if (behind != 0) {
    chosen = decoder->Get<kBlendedHaste>(lane, &choices_[behind]);
    decoder->GetBits(lane, 0);
  }
  if (chosen >= kCandidates) {
    const std::int32_t rest = longs_.Decode(lane, decoder);
    return view.median + sense * (static_cast<int>(kLongMagnitude) + rest);
  }
  const unsigned symbol = decoder->Get<kBlendedHaste>(lane, &distances_[chosen]);
  const ResidualClass& c = kResidualClasses[symbol];
  std::int32_t off =
      c.base + static_cast<std::int32_t>(decoder->GetBits(lane, static_cast<unsigned>(c.bits)));
  if (symbol >= kFirstLongSymbol) off += longs_.Decode(lane, decoder);
  return view.candidates[chosen] + sense * ((off ^ c.sign) - c.sign);
}

template <class T>
void BlendedChannel::EncodeRow(std::uint32_t beam, const std::uint16_t* columns, std::size_t count,
                               const T* values, RansEncoder* encoder) {
  StartRow(beam);
  RansEncoder::Writer writer(encoder);
  for (std::size_t i = 0; i < count; ++i) {
    const unsigned lane = i % kRansLanes;
    const View view = Look(columns[i]);
    const std::int32_t value = values[i];
    const std::int32_t difference = (value - view.median) * view.mirror;
    const ClassedResidual coded(static_cast<std::uint32_t>(std::abs(difference)), difference < 0);
    writer.Put(lane, coded.symbol, view.models, coded.low, coded.bits);
    if (coded.is_long)
      EncodeJump(view, value, difference < 0 ? -view.mirror : view.mirror, lane, &writer);
    Keep(view, value, columns[i]);
  }
  EndRow(beam);
}

bool BlendedChannel::DecodeRow(std::uint32_t beam, const std::uint16_t* columns, std::size_t count,
                               std::int32_t* values, RansDecoder* decoder) {
  StartRow(beam);
  RansDecoder local = *decoder;
  for (std::size_t i = 0; i < count; ++i) {
    const unsigned lane = i % kRansLanes;
    const View view = Look(columns[i]);
    const unsigned symbol = local.Get(lane, view.models);
    const ResidualClass& c = kResidualClasses[symbol];
    const auto low =
        static_cast<std::int32_t>(local.GetBits(lane, static_cast<unsigned>(c.bits), c.mask));
    const std::int32_t sign = c.sign ^ (view.mirror >> 31);
    std::int32_t value = view.median + (((c.base + low) ^ sign) - sign);
    if (__builtin_expect(symbol >= kFirstLongSymbol, 0))
      value = DecodeJump(view, sign | 1, lane, &local);
    if (static_cast<std::uint32_t>(value) >= static_cast<std::uint32_t>(limit_)) return false;
    values[i] = value;
    Keep(view, value, columns[i]);
  }
  EndRow(beam);
  *decoder = local;
  return !local.overran();
}

void BlendedCoder::Reset(const BlockShape& shape, bool with_levels) {
  values_.Reset(shape, InitialModelsOfValues());
  if (with_levels) levels_.Reset(shape, InitialModelsOfLevels());
}

void BlendedCoder::Encode(const BlockShape& shape, const IntegerLists& lists,
                          RansEncoder* encoder) {
  Reset(shape, !lists.levels.empty());
  ForEachRowOf(shape, &columns_, [&](std::uint32_t beam, std::size_t count, std::size_t first) {
    values_.EncodeRow(beam, columns_.data(), count, &lists.values[first], encoder);
    if (!lists.levels.empty())
      levels_.EncodeRow(beam, columns_.data(), count, &lists.levels[first], encoder);
    return true;
  });
}

bool BlendedCoder::Decode(const BlockShape& shape, const RangeGrid& grid, RansDecoder* decoder,
                          RangeImage* image) {
  Reset(shape, !image->intensity.empty());
  image->ranges.assign(image->size(), 0);
  return ForEachRowOf(shape, &columns_, [&](std::uint32_t beam, std::size_t count, std::size_t) {
    row_.resize(count);
    if (!values_.DecodeRow(beam, columns_.data(), count, row_.data(), decoder) ||
        !grid.ToRanges(&row_)) {
      return false;
    }
    const std::size_t first = std::size_t{beam} * shape.columns;
    for (std::size_t i = 0; i < count; ++i)
      image->ranges[first + columns_[i]] = static_cast<std::uint32_t>(row_[i]);
    if (image->intensity.empty()) return true;
    if (!levels_.DecodeRow(beam, columns_.data(), count, row_.data(), decoder)) return false;
    for (std::size_t i = 0; i < count; ++i)
      image->intensity[first + columns_[i]] = static_cast<std::uint8_t>(row_[i]);
    return true;
  });
}

}  // namespace lidar::codec
