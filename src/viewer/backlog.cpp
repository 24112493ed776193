// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/viewer/backlog.h"

#include <algorithm>

namespace lidar::viewer {
namespace {

/// The estimated memory of a slice in addition to its bytes.
constexpr std::size_t kOverhead = 256;

std::size_t CostOf(const Slice& slice) {
  return kOverhead + static_cast<std::size_t>(slice.size.bytes());
}

bool StandsAlone(const Slice& slice) {
  return std::all_of(slice.blocks.begin(), slice.blocks.end(),
                     [](const codec::BlockName& block) { return !block.reference; });
}

bool HasName(const Slice& slice, std::uint32_t crc) {
  return std::any_of(slice.blocks.begin(), slice.blocks.end(),
                     [crc](const codec::BlockName& block) { return block.crc == crc; });
}

}  // namespace

void Backlog::Push(SharedSlice slice) {
  if (slice->id.scan != newest_) {
    before_ = newest_;
    newest_ = slice->id.scan;
  }
  if (const Slice* reference = ReferenceOf(*slice)) {
    if (StandsAlone(*reference)) EraseBefore(*reference);
  }
  bytes_ += CostOf(*slice);
  slices_.push_back(std::move(slice));
  // Drops old slices without blocks. No slice can refer to them, so they are only useful for
  // display while they are new.
  for (auto it = slices_.begin(); it != slices_.end();)
    it = (*it)->blocks.empty() && !IsRecent(**it) ? Erase(it) : std::next(it);
  while (bytes_ > most_bytes_) Erase(slices_.begin());
}

SharedSlice Backlog::Pop() {
  if (slices_.empty()) return nullptr;
  SharedSlice slice = slices_.front();
  Erase(slices_.begin());
  return slice;
}

Backlog::Iterator Backlog::Erase(Iterator slice) {
  bytes_ -= CostOf(**slice);
  return slices_.erase(slice);
}

/// Removes the slices of the same sector that are before `key`.
void Backlog::EraseBefore(const Slice& key) {
  for (auto it = slices_.begin(); it->get() != &key;)
    it = (*it)->id.index == key.id.index ? Erase(it) : std::next(it);
}

/// Returns the slice to which `slice` refers, or null if the backlog does not have it.
const Slice* Backlog::ReferenceOf(const Slice& slice) const {
  for (const codec::BlockName& block : slice.blocks) {
    if (!block.reference) continue;
    const auto found = std::find_if(slices_.rbegin(), slices_.rend(), [&](const SharedSlice& s) {
      return s->id.index == slice.id.index && HasName(*s, *block.reference);
    });
    if (found != slices_.rend()) return found->get();
  }
  return nullptr;
}

}  // namespace lidar::viewer
