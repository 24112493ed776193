// SPDX-License-Identifier: LGPL-2.1-or-later
// Collects the points of a scan from its slices, with the phase of each point in the scan.
#pragma once
#include <optional>
#include <vector>

#include "ext/odometry/point_times.h"
#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidar.h"
#include "src/odometry/odometry.h"

namespace lidar::gst {

/// A collected scan. Some of its slices may be missing.
struct CollectedScan {
  odometry::TimedPoints points;
  Time start{};
  Duration duration{};
};

/// Collects one scan after the other. Only one thread at a time may use it.
class ScanCollector {
 public:
  /// Sets the layout of later buffers. Returns false if x, y and z are not adjacent F32.
  bool SetInfo(const CloudInfo& info);

  /// Returns true if `slice` cannot be added to the open scan, because it belongs to another scan,
  /// or because the open scan has too many points.
  bool BeginsNewScan(const GstLidarSlice& slice) const;
  /// Adds a slice to the open scan, or begins a scan with it. Its first column was sampled at
  /// `time`. The `size` bytes at `points` must be whole points, and whole columns if the cloud is
  /// organised.
  void Add(const GstLidarSlice& slice, Time time, const guint8* points, gsize size);
  /// Returns true if the open scan has its last slice.
  bool complete() const { return open_ && next_index_ >= count_; }
  /// Returns the open scan and closes it. Returns nothing if no scan is open.
  std::optional<CollectedScan> Take();

 private:
  void Open(const GstLidarSlice& slice, Time time);
  std::vector<float> PhasesOf(const GstLidarSlice& slice, const PointsInMemory& points) const;

  CloudInfo info_;
  std::optional<PointField> time_, ring_;  // set if the points have these fields
  CollectedScan scan_;
  bool open_ = false;
  guint scan_id_ = 0;
  guint next_index_ = 0;
  guint count_ = 1;
};

}  // namespace lidar::gst
