// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/mixing/slice_coder.h"

#include <type_traits>

#include "src/codec/mixing/bin_search.h"
#include "src/codec/mixing/level_part.h"
#include "src/codec/mixing/mask_part.h"
#include "src/codec/mixing/range_part.h"
#include "src/codec/mixing/temporal_part.h"

namespace lidar::codec::mixing {
namespace {

constexpr auto kMargin = static_cast<std::ptrdiff_t>(AlignedRow<Azimuth>::kMargin);

/// The numbers of contexts, centres and candidates that an effort uses, and its flags.
struct Effort1 {
  static constexpr unsigned kLevelContexts = 6;
  static constexpr unsigned kMaskContexts = 3;
  static constexpr unsigned kRangeContexts = 5;
  static constexpr unsigned kCentres = 0;
  static constexpr unsigned kCandidates = 5;
  static constexpr bool kEvents = false;
  static constexpr bool kSearches = false;
  static constexpr bool kRefined = false;
};
struct Effort2 {
  static constexpr unsigned kLevelContexts = mixing::kLevelContexts.size();
  static constexpr unsigned kMaskContexts = 6;
  static constexpr unsigned kRangeContexts = 10;
  static constexpr unsigned kCentres = mixing::kCentres;
  static constexpr unsigned kCandidates = mixing::kCandidates;
  static constexpr bool kEvents = true;
  static constexpr bool kSearches = false;
  static constexpr bool kRefined = false;
};
struct Effort3 : Effort2 {
  static constexpr unsigned kRangeContexts = 13;
  static constexpr bool kSearches = true;
};
template <class Effort>
struct Refined : Effort {
  static constexpr bool kRefined = true;
};

/// Returns true if a decoder has read past the end of its stream. The caller must then stop,
/// because the decoder itself continues to return bits.
bool Overran(const BinaryDecoder& coder) { return coder.overran(); }
template <class Coder>
bool Overran(const Coder& /*coder*/) {
  return false;
}

/// Replaces BinSearch at efforts that do not search.
struct NoSearch {
  NoSearch(Model* /*model*/, std::int64_t /*step_mm*/, std::vector<SearchStep>* /*steps*/) {}
};

}  // namespace

void SliceCoder::FillNorth(const Azimuth* above, std::uint32_t columns) {
  const auto end = static_cast<std::ptrdiff_t>(columns) + kMargin;
  std::ptrdiff_t first = -kMargin;
  while (first < end && above[first].values[0] == kUnknown) ++first;
  std::int32_t last = first < end ? above[first].values[0] : kUnknown;
  for (std::ptrdiff_t i = -kMargin; i < end; ++i) {
    if (above[i].values[0] != kUnknown) last = above[i].values[0];
    north_[static_cast<std::size_t>(i + kMargin)] = last;
  }
}

template <class Effort, class Coder>
bool SliceCoder::CodeBins(Model* model, SliceBins* slice, Coder* coder) {
  MaskPart<Effort::kMaskContexts, Coder, Effort::kRefined> mask(model, coder);
  RangePart<Effort, Coder> range(model, coder, slice->step_mm);
  constexpr bool kSearches = Effort::kSearches && !Coder::kDecodes;
  [[maybe_unused]] std::conditional_t<kSearches, BinSearch<Effort>, NoSearch> search(
      model, slice->step_mm, &search_steps_);
  for (std::uint32_t beam = 0; beam < slice->beams; ++beam) {
    Azimuth* const above = above_.At(beam);
    const std::size_t row = std::size_t{beam} * slice->columns;
    std::int32_t* const bins = &slice->bins[row];
    FillNorth(above, slice->columns);
    if constexpr (kSearches) {
      if (!slice->spare.empty())
        search.Choose({above, &north_[kMargin], &slice->spare[row], slice->columns}, bins);
    }
    mask.StartRow(above);
    range.StartRow(above, &north_[kMargin]);
    for (std::uint32_t i = 0; i < slice->columns; ++i) {
      const bool is_return = !slice->has_gaps || mask.Code(bins[i] >= 0, i, range.NearClass(i));
      if (is_return) {
        bins[i] = range.Code(bins[i], i, &above[i]);
        if (bins[i] < 0) return false;
      } else {
        bins[i] = kNoReturn;
        range.Skip(i);
        above[i].residual = 0;
      }
      above[i].returns = static_cast<std::uint8_t>(above[i].returns << 1 | (is_return ? 1 : 0));
    }
    above_.CloseTurn(beam);
    if (Overran(*coder)) return false;
  }
  return true;
}

/// Codes the bins of a slice. For a pixel of which TemporalPart::Knows() is true, the bin is
/// predicted by the pixel's memory. The bins of the other pixels are coded as CodeBins() does.
template <class Effort, class Coder>
bool SliceCoder::CodeRecalledBins(Model* model, SliceBins* slice, Coder* coder,
                                  const Recollection& recollection) {
  using Temporal = TemporalPart<Coder>;
  MaskPart<Temporal::kSpatialMask, Coder> mask(model, coder);
  RangePart<Effort, Coder> range(model, coder, slice->step_mm);
  Temporal temporal(recollection.grid, recollection.memory.model, coder);
  surprises_.Reset(alignment_, slice->columns, {});
  for (std::uint32_t beam = 0; beam < slice->beams; ++beam) {
    Azimuth* const above = above_.At(beam);
    const std::size_t row = std::size_t{beam} * slice->columns;
    std::int32_t* const bins = &slice->bins[row];
    FillNorth(above, slice->columns);
    mask.StartRow(above);
    range.StartRow(above, &north_[kMargin]);
    temporal.StartRow(&recollection.memory.pixels[row], slice->columns, surprises_.At(beam));
    for (std::uint32_t i = 0; i < slice->columns; ++i) {
      temporal.Look(i);
      const bool is_return =
          !slice->has_gaps ||
          mask.CodeBy(bins[i] >= 0, i, range.NearClass(i), [&](bool bit, auto&& counter_at) {
            return temporal.CodeReturn(bit, counter_at);
          });
      if (is_return) {
        std::int32_t bin = Temporal::kFarAway;
        if (temporal.Knows()) bin = temporal.CodeBin(bins[i], range.SurroundingsOf(i));
        if (bin >= 0) {
          range.See(bin, &above[i]);
        } else {
          bin = range.Code(bins[i], i, &above[i]);
        }
        if (bin < 0 || bin >= kMaxBins) return false;
        bins[i] = bin;
        temporal.SeeBin(bin);
      } else {
        bins[i] = kNoReturn;
        range.Skip(i);
        above[i].residual = 0;
        temporal.SeeGap();
      }
      above[i].returns = static_cast<std::uint8_t>(above[i].returns << 1 | (is_return ? 1 : 0));
    }
    above_.CloseTurn(beam);
    surprises_.CloseTurn(beam);
    if (Overran(*coder)) return false;
  }
  return true;
}

template <class Effort, class Coder>
bool SliceCoder::CodeLevels(Model* model, SliceBins* slice, Coder* coder) {
  using Part = LevelPart<Effort::kLevelContexts, Coder>;
  Part part(model, coder, slice->level_bits, slice->step_mm);
  above_.Reset(alignment_, slice->columns, {});
  for (std::uint32_t beam = 0; beam < slice->beams; ++beam) {
    Azimuth* const above = above_.At(beam);
    const std::size_t row = std::size_t{beam} * slice->columns;
    const auto at = [](const Azimuth& azimuth) {
      // `values[0]` is the bin plus 1 in this pass, so that 0 means no return.
      return LevelAt{azimuth.values[0] - 1, azimuth.level, azimuth.level_residual};
    };
    typename Part::Around around{};
    part.StartRow();
    around.nw = at(above[-1]);
    for (std::uint32_t i = 0; i < slice->columns; ++i) {
      Azimuth& azimuth = above[i];
      const LevelAt old = at(azimuth);
      around.bin = slice->bins[row + i];
      if (around.bin < 0) {
        around.nw = old;
        continue;
      }
      around.n = old;
      around.ne = at(above[i + 1]);
      around.nn = {azimuth.values[1] - 1, azimuth.values[2], 0};
      std::int32_t residual = 0;
      const std::int32_t level = part.Code(slice->levels[row + i], around, &residual);
      if (level < 0) return false;
      slice->levels[row + i] = static_cast<std::uint8_t>(level);
      azimuth.values = {around.bin + 1, azimuth.values[0], azimuth.level};
      azimuth.level = static_cast<std::uint8_t>(level);
      azimuth.level_residual = static_cast<std::int8_t>(residual);
      around.ww = around.w;
      around.w = {around.bin, level, residual};
      around.nw = old;
    }
    above_.CloseTurn(beam);
    if (Overran(*coder)) return false;
  }
  return true;
}

template <class Effort, class Coder>
bool SliceCoder::CodeAll(Model* model, SliceBins* slice, Coder* coder,
                         const Recollection* recollection) {
  if constexpr (Effort::kRefined) {
    if (recollection != nullptr || !CodeBins<Effort>(model, slice, coder)) return false;
  } else {
    const bool coded = recollection != nullptr
                           ? CodeRecalledBins<Effort>(model, slice, coder, *recollection)
                           : CodeBins<Effort>(model, slice, coder);
    if (!coded) return false;
  }
  return slice->level_bits == 0 || CodeLevels<Effort>(model, slice, coder);
}

template <class Coder>
bool SliceCoder::Code(unsigned effort, Model* model, SliceBins* slice, Coder* coder,
                      const Recollection* recollection) {
  north_.resize(slice->columns + 2 * AlignedRow<Azimuth>::kMargin);
  above_.Reset(alignment_, slice->columns, {});
  if (effort == 1) return CodeAll<Effort1>(model, slice, coder, recollection);
  if (slice->refined) {
    return effort == 2 ? CodeAll<Refined<Effort2>>(model, slice, coder, recollection)
                       : CodeAll<Refined<Effort3>>(model, slice, coder, recollection);
  }
  if (effort == 2) return CodeAll<Effort2>(model, slice, coder, recollection);
  return CodeAll<Effort3>(model, slice, coder, recollection);
}

template bool SliceCoder::Code(unsigned, Model*, SliceBins*, BinaryEncoder*, const Recollection*);
template bool SliceCoder::Code(unsigned, Model*, SliceBins*, BinaryDecoder*, const Recollection*);

}  // namespace lidar::codec::mixing
