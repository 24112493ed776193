// SPDX-License-Identifier: LGPL-2.1-or-later
// What dracoenc counts.
#pragma once
#include <gst/gst.h>

#include <cstdint>

#include "ext/draco/enc_error_check.h"
#include "src/codec/slice_encoder.h"
#include "src/rate/rate_loop.h"

namespace lidar::gst {

class EncStats {
 public:
  void OnScan(double scans_per_second);
  void OnSlice(const rate::LoopResult& result, const codec::EncodedSlice& slice,
               GstClockTime encode_time);
  /// `holds`: the errors are within max-error.
  void OnErrorCheck(const PointErrors& errors, bool holds);
  /// transfer full
  GstStructure* ToStructure(guint target_bps) const;
  guint64 slices_out_of_reach() const { return out_of_reach_; }

 private:
  void CloseScan();

  guint64 scans_in_ = 0;
  guint64 scans_encoded_ = 0;
  guint64 scans_skipped_ = 0;
  guint64 slices_ = 0;
  guint64 slices_skipped_ = 0;
  guint64 slices_empty_ = 0;
  guint64 out_of_reach_ = 0;
  guint64 bytes_ = 0;
  guint64 returns_ = 0;
  GstClockTime encode_time_ = 0;
  GstClockTime last_encode_time_ = 0;
  codec::EncodedSlice last_;  // without its bytes
  rate::LoopResult last_result_;
  bool scan_has_slices_ = false;
  bool scan_was_skipped_ = false;
  guint64 scan_bytes_ = 0;
  guint64 error_checks_ = 0;
  guint64 error_checks_failed_ = 0;
  guint64 points_checked_ = 0;
  double largest_error_m_ = 0;
  double sum_of_errors_m_ = 0;
  double bitrate_ = 0;  // smoothed over about ten scans
  double scans_per_second_ = 10;
};

}  // namespace lidar::gst
