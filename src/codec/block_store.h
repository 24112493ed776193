// SPDX-License-Identifier: LGPL-2.1-or-later
// The blocks to which later blocks may refer, in bounded memory.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>

#include "src/codec/block_memory.h"

namespace lidar::codec {

/// An encoder refers to newer and newer blocks of a sector, so blocks older than a reference can be
/// dropped.
class BlockStore {
 public:
  /// Limits of the blocks of a sector, and of the bytes of all blocks. Encoders have lower limits,
  /// so a block to which they refer is still here.
  static constexpr std::size_t kMostOfSector = 24;
  static constexpr std::size_t kMostBytes = 64U << 20;
  /// Number of blocks older than a reference that are kept for late slices.
  static constexpr std::size_t kOvertaking = 3;

  void Add(BlockMemoryPtr block);
  /// Returns the block named `crc` at `place`, or null. Drops much older blocks of its sector.
  BlockMemoryPtr Recall(std::uint32_t crc, const RangeImage& place);

  std::size_t size() const { return blocks_.size(); }

 private:
  void DropFirst(std::size_t count, const BlockMemory& like);

  std::deque<BlockMemoryPtr> blocks_;  // the oldest first
  std::size_t bytes_ = 0;
};

}  // namespace lidar::codec
