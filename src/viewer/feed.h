// SPDX-License-Identifier: LGPL-2.1-or-later
// Chooses the slices for a viewer: those of the newest scans that its pace allows, as the robot
// coded them if the viewer has their references, otherwise re-coded.
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <unordered_set>
#include <vector>

#include "src/codec/slice_links.h"
#include "src/viewer/pace.h"

namespace lidar::viewer {

/// A message to viewers; the caller may derive from it.
struct Slice {
  virtual ~Slice() = default;
  SliceId id;
  std::uint32_t count = 1;               // of the scan's slices
  bool is_recoded = false;               // the slice stands alone
  std::vector<codec::BlockName> blocks;  // in the robot's own coding
  DataSize size;                         // of the message
};
using SharedSlice = std::shared_ptr<const Slice>;

/// The newest scans of a stream, for all of its viewers.
class RecentScans {
 public:
  struct Forms {
    SharedSlice own;      // as the robot coded it
    SharedSlice recoded;  // stands alone
  };
  struct Scan {
    std::uint32_t number = 0;
    std::map<std::uint32_t, Forms> slices;  // by index in the scan
  };
  /// Adds a slice. Only the two newest scans are kept, because viewers need no slices of older
  /// scans.
  void Add(SharedSlice slice);
  /// The oldest first.
  const std::deque<Scan>& scans() const { return scans_; }

 private:
  std::deque<Scan> scans_;
};

/// Returns the slices from `first` on, and earlier ones that they refer to, directly or not.
std::vector<SharedSlice> WithReferences(const std::vector<SharedSlice>& slices, std::size_t first);

class Feed {
 public:
  explicit Feed(DataRate max_bitrate) : pace_(max_bitrate) {}

  /// Returns the slices to send now, in this order, and counts them as sent. Call it after each new
  /// slice, after each drawn slice, and at intervals.
  std::vector<SharedSlice> Take(Time now, const RecentScans& recent);
  /// Takes slices of a recording from the front of `waiting`, as the pace allows, and skips no
  /// slice. Call it as Take().
  std::vector<SharedSlice> TakeRecorded(Time now, std::deque<SharedSlice>* waiting);
  void OnDrawn(Time now, SliceId slice) { pace_.OnDrawn(now, slice); }
  /// The viewer's decoder lacks a reference: from now on it gets slices that stand alone.
  void OnLacksReference();

  /// Returns true if the viewer is too slow for the next scan to begin.
  bool IsLate(Time now) const { return pace_.IsLate(now); }
  /// Returns true if the viewer waits for a re-coded slice.
  bool wants_recoded() const { return wants_recoded_; }
  /// Number of scans that the pace skipped.
  std::uint64_t scans_skipped() const { return scans_skipped_; }

 private:
  struct Taken {
    std::uint32_t scan = 0;
    std::unordered_set<std::uint32_t> sent;  // indices of the slices sent
  };
  void Begin(Time now, const RecentScans& recent);
  bool Knows(const Slice& slice) const;
  void Learn(const Slice& slice);

  Pace pace_;
  std::deque<Taken> taken_;                  // begun scans among the recent ones
  std::unordered_set<std::uint32_t> known_;  // names of blocks that the viewer has
  std::deque<std::uint32_t> order_;          // the same, oldest first
  std::optional<std::uint32_t> newest_;      // last scan that appeared
  bool skipping_ = false;                    // the newest scan was not begun
  std::uint64_t scans_skipped_ = 0;
  bool wants_recoded_ = false;
};

}  // namespace lidar::viewer
