// SPDX-License-Identifier: LGPL-2.1-or-later
// Stores the blocks to which later blocks may refer, in bounded memory.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>

#include "src/codec/block_memory.h"

namespace lidar::codec {

/// An encoder refers to ever newer blocks of a sector. Blocks older than a reference can therefore
/// be dropped.
class BlockStore {
 public:
  /// The largest number of blocks of a sector, and the largest size of all blocks. An encoder has
  /// lower limits, so the store still has the blocks to which the encoder refers.
  static constexpr std::size_t kMostOfSector = 24;
  static constexpr std::size_t kMostBytes = 64U << 20;
  /// The number of blocks older than a reference that are kept. Slices that arrive late may need
  /// them.
  static constexpr std::size_t kOvertaking = 3;

  void Add(BlockMemoryPtr block);
  /// Returns the block with this `crc` and the same sector as `place`, or null. Drops older blocks
  /// of the sector, except for kOvertaking of them.
  BlockMemoryPtr Recall(std::uint32_t crc, const RangeImage& place);

  std::size_t size() const { return blocks_.size(); }

 private:
  void DropFirst(std::size_t count, const BlockMemory& like);

  std::deque<BlockMemoryPtr> blocks_;  // the oldest first
  std::size_t bytes_ = 0;
};

}  // namespace lidar::codec
