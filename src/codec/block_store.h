// SPDX-License-Identifier: LGPL-2.1-or-later
// The blocks that a decoder may be asked to remember, in bounded memory.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>

#include "src/codec/block_memory.h"

namespace lidar::codec {

/// An encoder refers to ever newer blocks of a sector, so what is older than a reference can go.
class BlockStore {
 public:
  /// The newest of each sector. An encoder stays below both, so that what it refers to is there.
  static constexpr std::size_t kMostOfSector = 24;
  static constexpr std::size_t kMostBytes = 64U << 20;
  /// How many blocks before a reference are kept, for slices that come late.
  static constexpr std::size_t kOvertaking = 3;

  void Add(BlockMemoryPtr block);
  /// The block of that name and place; null where there is none. Forgets much older ones of its
  /// sector.
  BlockMemoryPtr Recall(std::uint32_t crc, const RangeImage& place);

  std::size_t size() const { return blocks_.size(); }

 private:
  void DropFirst(std::size_t count, const BlockMemory& like);

  std::deque<BlockMemoryPtr> blocks_;  // the oldest first
  std::size_t bytes_ = 0;
};

}  // namespace lidar::codec
