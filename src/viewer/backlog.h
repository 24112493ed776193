// SPDX-License-Identifier: LGPL-2.1-or-later
// Keeps undecoded slices. A decoder that starts later needs them to follow the stream.
#pragma once
#include <cstddef>
#include <list>

#include "src/viewer/feed.h"

namespace lidar::viewer {

/// Slices that wait for a decoder. In each sector, an encoder refers only to ever newer slices. If
/// a slice refers to a slice that has no references itself, no decoder needs the slices of the
/// sector before that reference any more.
class Backlog {
 public:
  explicit Backlog(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// Adds a slice. Drops slices that are no longer needed, and the oldest slices if the memory is
  /// exceeded.
  void Push(SharedSlice slice);
  /// Removes the oldest slice and returns it. Returns null if there are no slices.
  SharedSlice Pop();

  bool empty() const { return slices_.empty(); }
  std::size_t size() const { return slices_.size(); }
  /// Returns true if the backlog is half full. A decoder should then decode slices, because slices
  /// that are needed would soon be dropped.
  bool is_full() const { return bytes_ > most_bytes_ / 2; }
  /// Returns true if the slice belongs to one of the two newest scans.
  bool IsRecent(const Slice& slice) const {
    return slice.id.scan == newest_ || slice.id.scan == before_;
  }

 private:
  using Iterator = std::list<SharedSlice>::iterator;
  Iterator Erase(Iterator slice);
  void EraseBefore(const Slice& key);
  const Slice* ReferenceOf(const Slice& slice) const;

  const std::size_t most_bytes_;
  std::list<SharedSlice> slices_;
  std::size_t bytes_ = 0;
  std::uint32_t newest_ = 0;
  std::uint32_t before_ = 0;
};

}  // namespace lidar::viewer
