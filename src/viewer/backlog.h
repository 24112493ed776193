// SPDX-License-Identifier: LGPL-2.1-or-later
// Undecoded slices that a late decoder needs to follow the stream.
#pragma once
#include <cstddef>
#include <list>

#include "src/viewer/feed.h"

namespace lidar::viewer {

/// Slices that wait for a decoder. An encoder refers to ever newer slices of a sector. So once a
/// slice refers to a slice that stands alone, all slices of the sector before that reference are
/// obsolete.
class Backlog {
 public:
  explicit Backlog(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// Drops obsolete slices, and the oldest ones above the bound.
  void Push(SharedSlice slice);
  /// Takes the oldest slice; null if there is none.
  SharedSlice Pop();

  bool empty() const { return slices_.empty(); }
  std::size_t size() const { return slices_.size(); }
  /// Returns true if needed slices must soon be dropped: then a decoder should take them.
  bool is_full() const { return bytes_ > most_bytes_ / 2; }
  /// Returns true for a slice of the two newest scans.
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
