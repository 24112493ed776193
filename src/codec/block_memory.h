// SPDX-License-Identifier: LGPL-2.1-or-later
// The memory that a block passes on to later blocks of the same sector (docs/temporal-coder.md):
// the earlier ranges of each pixel, and the models that use them.
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

/// The statistics of the earlier ranges of a pixel.
struct PixelMemory {
  std::uint32_t mean = 0;    // mean range, in 1/8 mm
  std::uint16_t spread = 0;  // mean distance of ranges from `mean`, in 1/8 mm
  std::uint8_t count = 0;    // number of returns in `mean`, up to kMostCount
  std::uint8_t returns = 0;  // bit n: whether the n-th scan before the newest had a return

  static constexpr std::uint32_t kPerMm = 8;
  static constexpr std::uint8_t kMostCount = 16;

  /// Adds the range of the next scan. `range_mm` was decoded on a grid of `step` [1/8 mm]. It is 0
  /// if the pixel has no return.
  void See(std::uint32_t range_mm, std::int64_t step);
};

/// Returns the width of a bin in 1/8 mm, the unit of PixelMemory.
inline std::int64_t StepOf(const RangeGrid& grid) {
  return std::int64_t{grid.unit_mm()} * grid.parts() * PixelMemory::kPerMm / RangeGrid::kParts;
}

struct BlockMemory {
  std::uint32_t beams = 0;
  std::uint32_t columns = 0;
  std::uint32_t first_column = 0;
  std::uint32_t crc = 0;  // name of the block: CRC of the block and its header
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
/// A memory is constant, because encoders, decoders and stores share it.
using BlockMemoryPtr = std::shared_ptr<const BlockMemory>;

/// The memory that a block is coded with, and the memory that it leaves for later blocks.
struct BlockLink {
  BlockMemoryPtr reference;           // memory that the block is coded with; null: none
  std::shared_ptr<BlockMemory> left;  // memory after the block; null: no block can refer to it
};

/// Returns the memory for blocks after `image`. `image` must have the decoded ranges. `before` is
/// the memory that `image` was coded with; if it is null, the new memory and its model begin anew.
std::shared_ptr<BlockMemory> Remember(const RangeImage& image, const RangeGrid& grid,
                                      const BlockMemory* before);

}  // namespace lidar::codec
