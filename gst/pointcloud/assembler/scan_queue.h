// SPDX-License-Identifier: LGPL-2.1-or-later
// The scans that are being assembled, and their deadlines.
#pragma once
#include <deque>
#include <optional>
#include <vector>

#include "gst/pointcloud/assembler/scan_builder.h"

namespace lidar::gst {

struct ScanCounters {
  guint64 scans = 0;       // number of finished scans
  guint64 incomplete = 0;  // number of finished scans with missing slices
  guint64 late = 0;        // number of slices that arrived after their scan was finished
  guint64 duplicates = 0;
  guint64 invalid = 0;
};

/// Assembles scans and finishes them in order. At most two scans are open: the scan that the sensor
/// is measuring now, and the scan before it, whose last slices may still arrive. The queue has no
/// clock; all times are running times that the caller passes.
class ScanQueue {
 public:
  using Finished = std::vector<FinishedScan>;

  /// Adds a slice. Appends to `finished` the scans that the slice completes, and older scans that
  /// it displaces. If the slice begins a scan, the scan waits for further slices until `deadline`.
  /// If `deadline` is NONE, it waits until a slice of the next scan is added.
  void Add(const SliceView& slice, GstClockTime deadline, Finished* finished);
  /// Finishes the scans whose deadline is `now` or earlier, and appends them to `finished`.
  void FinishDue(GstClockTime now, Finished* finished);
  void FinishAll(Finished* finished);
  /// Drops all open scans, and forgets which scans have been finished, for example after a flush.
  void Clear();

  /// Returns the earliest deadline, or NONE if no scan has a deadline.
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
  std::optional<guint> newest_left_;  // id of the newest finished scan
  ScanCounters counters_;
};

}  // namespace lidar::gst
