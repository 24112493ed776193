// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/block_store.h"

#include <algorithm>
#include <utility>

namespace lidar::codec {

/// Removes the `count` oldest blocks that are of the same sector as `like`.
void BlockStore::DropFirst(std::size_t count, const BlockMemory& like) {
  const auto is_due = [&](const BlockMemoryPtr& block) {
    if (count == 0 || !block->IsSectorOf(like)) return false;
    --count;
    bytes_ -= block->bytes();
    return true;
  };
  blocks_.erase(std::remove_if(blocks_.begin(), blocks_.end(), is_due), blocks_.end());
}

void BlockStore::Add(BlockMemoryPtr block) {
  std::size_t of_sector = 0;
  for (const BlockMemoryPtr& known : blocks_) {
    if (!known->IsSectorOf(*block)) continue;
    if (known->crc == block->crc) return;
    ++of_sector;
  }
  if (of_sector >= kMostOfSector) DropFirst(of_sector + 1 - kMostOfSector, *block);
  bytes_ += block->bytes();
  blocks_.push_back(std::move(block));
  while (bytes_ > kMostBytes && blocks_.size() > 1) {
    bytes_ -= blocks_.front()->bytes();
    blocks_.pop_front();
  }
}

BlockMemoryPtr BlockStore::Recall(std::uint32_t crc, const RangeImage& place) {
  std::size_t older = 0;
  for (const BlockMemoryPtr& block : blocks_) {
    if (!block->Fits(place)) continue;
    if (block->crc != crc) {
      ++older;
      continue;
    }
    const BlockMemoryPtr found = block;
    // A few older blocks are kept, because slices that refer to them may arrive late.
    DropFirst(older - std::min(older, kOvertaking), *found);
    return found;
  }
  return nullptr;
}

}  // namespace lidar::codec
