// SPDX-License-Identifier: LGPL-2.1-or-later
// An unfinished scan: takes slices in any order, and makes a whole cloud.
#pragma once
#include <vector>

#include "gst/common/refs.h"
#include "gst/lidar/cloud_info.h"

namespace lidar::gst {

/// A slice with its caps.
struct SliceView {
  GstBuffer* buffer = nullptr;  // not owned
  const CloudInfo* info = nullptr;
  GstLidarSlice meta{};
};

/// A finished cloud with its times.
struct FinishedScan {
  BufferPtr buffer;
  guint width = 0;  // columns, or points of an unorganised cloud
  bool complete = false;
};

class ScanBuilder {
 public:
  /// Returns false for slices that cannot be part of a scan: an index past the count, a size that
  /// does not fit the caps, or more columns than a sensor has.
  static bool IsSane(const SliceView& slice);
  /// Returns true for clouds whose points stand in columns and keep their places in the scan.
  /// Points of other clouds are joined in order.
  static bool IsOrganised(const CloudInfo& info) { return info.height > 1 || info.sensor_model; }

  /// `slice` must be sane. The constructor does not add it.
  explicit ScanBuilder(const SliceView& slice);

  guint scan_id() const { return scan_id_; }
  /// Returns true if the slice is of this scan and has its slice count. The caps of the slice must
  /// mix with those of the first slice (see CannotMix()).
  bool Fits(const SliceView& slice) const;
  /// Returns false for a duplicate, or if memory cannot be mapped.
  bool Add(const SliceView& slice);
  bool complete() const { return present_count_ == present_.size(); }
  /// PTS of the scan's first column, known or counted back; NONE if no slice had one.
  GstClockTime pts() const { return pts_; }
  GstClockTime duration() const { return duration_; }
  /// Returns the scan, with zeros for missing columns. No other call may follow.
  FinishedScan Finish();

 private:
  void TakeTimes(const SliceView& slice);
  bool CopyColumns(const SliceView& slice);
  void ZeroColumns(guint index);
  BufferPtr Concatenate(guint* points) const;

  guint scan_id_;
  CloudInfo info_;      // of one slice
  bool is_discont_;     // the first slice that came has the flag DISCONT
  guint first_column_;  // of the scan
  std::vector<bool> present_;
  std::size_t present_count_ = 0;
  GstClockTime pts_ = GST_CLOCK_TIME_NONE;
  GstClockTime capture_ = GST_CLOCK_TIME_NONE;
  GstClockTime duration_ = GST_CLOCK_TIME_NONE;
  BufferPtr scan_;                // of an organised cloud
  std::vector<BufferPtr> parts_;  // of an unorganised one
};

}  // namespace lidar::gst
