// SPDX-License-Identifier: LGPL-2.1-or-later
// Which slices a viewer gets: of the newest scans that its pace allows, each as the robot coded it
// where the viewer has what it refers to, else re-coded.
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
  bool is_recoded = false;               // it stands alone
  std::vector<codec::BlockName> blocks;  // of the robot's own
  DataSize size;                         // of the message
};
using SharedSlice = std::shared_ptr<const Slice>;

/// The newest scans of a stream, for all of its viewers.
class RecentScans {
 public:
  struct Forms {
    SharedSlice own;      // the robot's
    SharedSlice recoded;  // stands alone
  };
  struct Scan {
    std::uint32_t number = 0;
    std::map<std::uint32_t, Forms> slices;  // by their place
  };
  /// Forgets scans that are older than the two newest; their slices come too late.
  void Add(SharedSlice slice);
  /// The oldest first.
  const std::deque<Scan>& scans() const { return scans_; }

 private:
  std::deque<Scan> scans_;
};

class Feed {
 public:
  explicit Feed(DataRate max_bitrate) : pace_(max_bitrate) {}

  /// Returns what is to be sent now, in this order; it counts as sent. Call it when a slice has
  /// come, when the viewer has drawn one, and now and then.
  std::vector<SharedSlice> Take(Time now, const RecentScans& recent);
  void OnDrawn(Time now, SliceId slice) { pace_.OnDrawn(now, slice); }
  /// The viewer's decoder lacks something: it gets slices that stand alone.
  void OnLacksReference();

  /// What it got takes too long for the next scan to begin.
  bool IsLate(Time now) const { return pace_.IsLate(now); }
  /// It waits for the re-coded form of a slice.
  bool wants_recoded() const { return wants_recoded_; }
  /// Scans that the pace left out.
  std::uint64_t scans_skipped() const { return scans_skipped_; }

 private:
  struct Taken {
    std::uint32_t scan = 0;
    std::unordered_set<std::uint32_t> sent;  // places
  };
  void Begin(Time now, const RecentScans& recent);
  bool Knows(const Slice& slice) const;
  void Learn(const Slice& slice);

  Pace pace_;
  std::deque<Taken> taken_;                  // begun, among the recent ones
  std::unordered_set<std::uint32_t> known_;  // names of blocks that the viewer has
  std::deque<std::uint32_t> order_;          // the same, the oldest first
  std::optional<std::uint32_t> newest_;      // scan that was there last
  bool skipping_ = false;                    // it has not begun
  std::uint64_t scans_skipped_ = 0;
  bool wants_recoded_ = false;
};

}  // namespace lidar::viewer
