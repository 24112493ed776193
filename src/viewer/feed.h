// SPDX-License-Identifier: LGPL-2.1-or-later
// Chooses the slices that are sent to a viewer. They belong to the newest scans, as far as the pace
// of the viewer allows. A slice is sent as the robot encoded it if the viewer has its references,
// and re-coded otherwise.
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

/// A slice as a message to viewers. The caller may derive from this class.
struct Slice {
  virtual ~Slice() = default;
  SliceId id;
  std::uint32_t count = 1;               // number of slices in the scan
  bool is_recoded = false;               // re-coded, without references to others
  std::vector<codec::BlockName> blocks;  // blocks in the robot's own coding
  DataSize size;                         // size of the message
};
using SharedSlice = std::shared_ptr<const Slice>;

/// The newest scans of a stream. All viewers of the stream share them.
class RecentScans {
 public:
  struct Forms {
    SharedSlice own;      // the slice as the robot encoded it
    SharedSlice recoded;  // the slice without references to others
  };
  struct Scan {
    std::uint32_t number = 0;
    std::map<std::uint32_t, Forms> slices;  // by index in the scan
  };
  /// Adds a slice. Keeps only the two newest scans, because viewers need no slices of older scans.
  void Add(SharedSlice slice);
  /// Returns the scans, the oldest first.
  const std::deque<Scan>& scans() const { return scans_; }

 private:
  std::deque<Scan> scans_;
};

/// Returns the slices from index `first` on, and the earlier slices to which they refer, directly
/// or indirectly.
std::vector<SharedSlice> WithReferences(const std::vector<SharedSlice>& slices, std::size_t first);

class Feed {
 public:
  explicit Feed(DataRate max_bitrate) : pace_(max_bitrate) {}

  /// Returns the slices to send now, in this order, and counts them as sent. Must be called after
  /// each new slice, after each drawn slice, and at regular intervals.
  std::vector<SharedSlice> Take(Time now, const RecentScans& recent);
  /// Removes slices of a recording from the front of `waiting`, as far as the pace allows, and
  /// returns them. Does not skip any slice. Must be called as often as Take().
  std::vector<SharedSlice> TakeRecorded(Time now, std::deque<SharedSlice>* waiting);
  void OnDrawn(Time now, SliceId slice) { pace_.OnDrawn(now, slice); }
  /// Notes that the viewer's decoder lacks a reference. The viewer now gets slices without
  /// references.
  void OnLacksReference();

  /// Returns true if the viewer is too slow to begin the next scan.
  bool IsLate(Time now) const { return pace_.IsLate(now); }
  /// Returns true if the viewer needs a re-coded slice.
  bool wants_recoded() const { return wants_recoded_; }
  /// Returns the number of scans that were skipped because of the pace.
  std::uint64_t scans_skipped() const { return scans_skipped_; }

 private:
  struct Taken {
    std::uint32_t scan = 0;
    std::unordered_set<std::uint32_t> sent;  // indices of the slices that were sent
  };
  void Begin(Time now, const RecentScans& recent);
  bool Knows(const Slice& slice) const;
  void Learn(const Slice& slice);

  Pace pace_;
  std::deque<Taken> taken_;                  // recent scans that have been begun
  std::unordered_set<std::uint32_t> known_;  // names of blocks that the viewer has
  std::deque<std::uint32_t> order_;          // the same names, the oldest first
  std::optional<std::uint32_t> newest_;      // newest scan so far
  bool skipping_ = false;                    // the newest scan was not yet begun
  std::uint64_t scans_skipped_ = 0;
  bool wants_recoded_ = false;
};

}  // namespace lidar::viewer
