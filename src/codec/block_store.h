// SPDX-License-Identifier: LGPL-2.1-or-later
// The blocks that a decoder may be asked to remember, in bounded memory.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>

#include "src/codec/block_memory.h"

namespace lidar::codec {

/// An encoder refers to newer and newer blocks of a sector, so blocks before a reference can go.
class BlockStore {
 public:
  /// Limits of a sector. An encoder keeps to lower ones, so that its references are here.
  static constexpr std::size_t kMostOfSector = 24;
  static constexpr std::size_t kMostBytes = 64U << 20;
  /// Number of blocks kept before a reference, for late slices.
  static constexpr std::size_t kOvertaking = 3;

  void Add(BlockMemoryPtr block);
  /// Returns the block of that name and place, or null. Forgets much older blocks of its sector.
  BlockMemoryPtr Recall(std::uint32_t crc, const RangeImage& place);

  std::size_t size() const { return blocks_.size(); }

 private:
  void DropFirst(std::size_t count, const BlockMemory& like);

  std::deque<BlockMemoryPtr> blocks_;  // the oldest first
  std::size_t bytes_ = 0;
};

}  // namespace lidar::codec
