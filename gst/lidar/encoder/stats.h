// SPDX-License-Identifier: LGPL-2.1-or-later
// The counters of an encoder.
#pragma once
#include <gst/gst.h>

#include "gst/common/refs.h"
#include "src/cloud/point_errors.h"
#include "src/rate/rate_loop.h"

namespace lidar::gst {

class EncoderStats {
 public:
  void OnScan(double scans_per_second);
  void OnSlice(const rate::LoopResult& result, GstClockTime encode_time);
  /// Counts an error check. `holds` is true if all errors are within max-error.
  void OnErrorCheck(const PointErrors& errors, bool holds);
  StructurePtr ToStructure(guint target_bps) const;

  struct Counters {
    guint64 scans_in = 0;
    guint64 scans_encoded = 0;
    guint64 scans_skipped = 0;
    guint64 slices = 0;
    guint64 slices_skipped = 0;
    guint64 slices_empty = 0;
    guint64 slices_out_of_reach = 0;
    guint64 bytes = 0;
    guint64 returns = 0;
    GstClockTime encode_time = 0;
    GstClockTime last_encode_time = 0;
    guint64 error_checks = 0;
    guint64 error_checks_failed = 0;
    guint64 points_checked = 0;
    gdouble largest_error_m = 0;
    gdouble sum_of_errors_m = 0;
    gdouble bitrate = 0;  // averaged over about ten scans
    rate::LoopResult last;
    guint target_bps = 0;
  };

 private:
  void CloseScan();

  Counters counters_;
  bool scan_has_slices_ = false;
  bool scan_was_skipped_ = false;
  guint64 scan_bytes_ = 0;
  double scans_per_second_ = 10;
};

}  // namespace lidar::gst
