// SPDX-License-Identifier: LGPL-2.1-or-later
// The scans that are being assembled, and their deadlines.
#pragma once
#include <deque>
#include <optional>
#include <vector>

#include "gst/pointcloud/assembler/scan_builder.h"

namespace lidar::gst {

struct ScanCounters {
  guint64 scans = 0;       // number that left
  guint64 incomplete = 0;  // number of incomplete ones among them
  guint64 late = 0;        // slices that came after their scan had left
  guint64 duplicates = 0;
  guint64 invalid = 0;
};

/// At most two scans are open: the one that the sensor sweeps, and the one before, whose last
/// slices may still be under way. Scans leave in order. The queue has no clock: times are the
/// caller's running time.
class ScanQueue {
 public:
  using Finished = std::vector<FinishedScan>;

  /// Takes a slice, and appends the scans that it completes or displaces. A scan that begins with
  /// this slice may stay until `deadline`; NONE: until a slice of the next scan.
  void Add(const SliceView& slice, GstClockTime deadline, Finished* finished);
  /// Appends the scans whose deadline is not after `now`.
  void FinishDue(GstClockTime now, Finished* finished);
  void FinishAll(Finished* finished);
  /// Forgets everything, as after a flush.
  void Clear();

  /// Earliest deadline, NONE if there is none.
  GstClockTime NextDeadline() const;
  bool empty() const { return open_.empty(); }
  const ScanCounters& counters() const { return counters_; }

 private:
  struct Open {
    ScanBuilder builder;
    GstClockTime deadline;
  };

  enum class Age { kNew, kLate, kRecut };
  Open* Find(const SliceView& slice);
  Age AgeOf(guint scan_id, Finished* finished);
  Open* MakeRoomAndOpen(const SliceView& slice, GstClockTime deadline, Finished* finished);
  void FinishFront(Finished* finished);

  std::deque<Open> open_;
  std::optional<guint> newest_left_;  // id of the newest scan that left
  ScanCounters counters_;
};

}  // namespace lidar::gst
