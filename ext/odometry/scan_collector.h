// SPDX-License-Identifier: LGPL-2.1-or-later
// Collects the points of a scan from its slices, with their phases in the sweep.
#pragma once
#include <optional>
#include <vector>

#include "ext/odometry/point_times.h"
#include "gst/lidar/cloud_info.h"
#include "gst/lidar/gstlidar.h"
#include "src/odometry/odometry.h"

namespace lidar::gst {

/// A scan; some of its slices may be missing.
struct CollectedScan {
  odometry::TimedPoints points;
  Time start{};
  Duration duration{};
};

/// Used by one thread at a time.
class ScanCollector {
 public:
  /// Sets the layout of the buffers that follow. Returns false if x, y and z are not packed F32.
  bool SetInfo(const CloudInfo& info);

  /// Returns true if the open scan cannot take `slice`: the slice is of another scan, or the open
  /// one has too many points.
  bool BeginsNewScan(const GstLidarSlice& slice) const;
  /// Adds a slice, whose first column was sampled at `time`, to the open scan or to a new one.
  /// `size` bytes at `points` are whole points, and whole columns if the cloud is organised.
  void Add(const GstLidarSlice& slice, Time time, const guint8* points, gsize size);
  /// Returns true if the last slice of the open scan is there.
  bool complete() const { return open_ && next_index_ >= count_; }
  /// Takes the open scan, if there is one.
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
