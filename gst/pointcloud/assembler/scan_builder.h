// SPDX-License-Identifier: LGPL-2.1-or-later
// Builds a whole scan from slices that are added in any order.
#pragma once
#include <vector>

#include "gst/common/refs.h"
#include "gst/lidar/cloud_info.h"

namespace lidar::gst {

/// A slice and the caps that describe it.
struct SliceView {
  GstBuffer* buffer = nullptr;  // not owned
  const CloudInfo* info = nullptr;
  GstLidarSlice meta{};
};

/// A finished scan, whose buffer has its times.
struct FinishedScan {
  BufferPtr buffer;
  guint width = 0;  // number of columns, or of points if the cloud is not organised
  bool complete = false;
};

class ScanBuilder {
 public:
  /// Returns false if the slice cannot be part of a scan: its index is not below the slice count,
  /// its size contradicts the caps, or the scan would have more columns than a sensor has.
  static bool IsSane(const SliceView& slice);
  /// Returns true if the points of a cloud are arranged in rows and columns. Then each slice is
  /// copied to its columns of the scan. The points of other clouds are concatenated in the order of
  /// the slices.
  static bool IsOrganised(const CloudInfo& info) { return info.height > 1 || info.sensor_model; }

  /// Begins the scan that `slice` belongs to, but does not add the slice. `slice` must be sane.
  explicit ScanBuilder(const SliceView& slice);

  guint scan_id() const { return scan_id_; }
  /// Returns true if the slice has the id and the slice count of this scan. The caller checks the
  /// caps with CannotMix().
  bool Fits(const SliceView& slice) const;
  /// Adds a slice. Returns false if the slice is a duplicate or if memory cannot be mapped.
  bool Add(const SliceView& slice);
  bool complete() const { return present_count_ == present_.size(); }
  /// Returns the PTS of the scan's first column, which may be extrapolated back from another slice.
  /// Returns NONE if no slice had a PTS.
  GstClockTime pts() const { return pts_; }
  GstClockTime duration() const { return duration_; }
  /// Returns the scan, in which missing columns are zeros. No other method may be called
  /// afterwards.
  FinishedScan Finish();

 private:
  void TakeTimes(const SliceView& slice);
  bool CopyColumns(const SliceView& slice);
  void ZeroColumns(guint index);
  BufferPtr Concatenate(guint* points) const;

  guint scan_id_;
  CloudInfo info_;      // caps of the slice with which the scan began
  bool is_discont_;     // the slice that arrived first has the flag DISCONT
  guint first_column_;  // first column of the scan
  std::vector<bool> present_;
  std::size_t present_count_ = 0;
  GstClockTime pts_ = GST_CLOCK_TIME_NONE;
  GstClockTime capture_ = GST_CLOCK_TIME_NONE;
  GstClockTime duration_ = GST_CLOCK_TIME_NONE;
  BufferPtr scan_;                // for organised clouds
  std::vector<BufferPtr> parts_;  // for other clouds, by slice index
};

}  // namespace lidar::gst
