// SPDX-License-Identifier: LGPL-2.1-or-later
// What a block leaves for later ones of its sector (docs/temporal-coder.md): where each pixel has
// seen something, and how the coder has learnt to use that.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/cloud/range_grid.h"
#include "src/codec/mixing/temporal_model.h"
#include "src/codec/range_image.h"

namespace lidar::codec {

/// What a pixel has seen.
struct PixelMemory {
  std::uint32_t mean = 0;    // of the range, in 1/8 mm
  std::uint16_t spread = 0;  // mean distance from it, in 1/8 mm
  std::uint8_t count = 0;    // returns in the mean, up to kMostCount; 0: none was seen yet
  std::uint8_t returns = 0;  // whether the last 8 scans had one, the last in bit 0

  static constexpr std::uint32_t kPerMm = 8;
  static constexpr std::uint8_t kMostCount = 16;

  /// The next scan has `range_mm` there, decoded on a grid of `step` [1/8 mm]; 0: no return.
  void See(std::uint32_t range_mm, std::int64_t step);
};

/// The width of a bin in units of PixelMemory.
inline std::int64_t StepOf(const RangeGrid& grid) {
  return std::int64_t{grid.unit_mm()} * grid.parts() * PixelMemory::kPerMm / RangeGrid::kParts;
}

struct BlockMemory {
  std::uint32_t beams = 0;
  std::uint32_t columns = 0;
  std::uint32_t first_column = 0;
  std::uint32_t crc = 0;  // of the whole block, header included: its name
  std::vector<PixelMemory> pixels;
  mixing::TemporalModel model;

  bool Fits(const RangeImage& image) const {
    return beams == image.beams && columns == image.columns && first_column == image.first_column;
  }
  bool IsSectorOf(const BlockMemory& other) const {
    return beams == other.beams && columns == other.columns && first_column == other.first_column;
  }
  std::size_t bytes() const { return sizeof *this + pixels.size() * sizeof(PixelMemory); }
};
/// A memory that others may see is never changed.
using BlockMemoryPtr = std::shared_ptr<const BlockMemory>;

/// How a block hangs together with others.
struct BlockLink {
  BlockMemoryPtr reference;           // to be coded by; null: the block stands alone
  std::shared_ptr<BlockMemory> left;  // by the block, which names itself; null where it is of
                                      // a coder that nothing can refer to
};

/// The memory after `image`, whose ranges are those that a decoder has. `before` is the memory
/// before it, and may be null. The model is a new one, or that of `before`.
std::shared_ptr<BlockMemory> Remember(const RangeImage& image, const RangeGrid& grid,
                                      const BlockMemory* before);

}  // namespace lidar::codec
