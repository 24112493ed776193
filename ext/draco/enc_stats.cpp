// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/draco/enc_stats.h"

#include <algorithm>

namespace lidar::gst {

void EncStats::OnScan(double scans_per_second) {
  if (scans_in_ > 0) CloseScan();
  scans_per_second_ = scans_per_second;
  ++scans_in_;
}

void EncStats::CloseScan() {
  constexpr double kGain = 0.1;
  const double rate = 8 * static_cast<double>(scan_bytes_) * scans_per_second_;
  bitrate_ += (scans_in_ == 1 ? 1 : kGain) * (rate - bitrate_);
  scan_bytes_ = 0;
  scan_has_slices_ = false;
  scan_was_skipped_ = false;
}

void EncStats::OnSlice(const rate::LoopResult& result, const codec::EncodedSlice& slice,
                       GstClockTime encode_time) {
  if (result.skipped) {
    ++slices_skipped_;
    if (!scan_was_skipped_) ++scans_skipped_;
    scan_was_skipped_ = true;
    return;
  }
  if (result.result == rate::CodingResult::kEmpty) ++slices_empty_;
  if (result.result == rate::CodingResult::kOutOfReach) ++out_of_reach_;
  if (result.result != rate::CodingResult::kEncoded) return;
  if (!scan_has_slices_) ++scans_encoded_;
  scan_has_slices_ = true;
  ++slices_;
  bytes_ += slice.bytes.size();
  scan_bytes_ += slice.bytes.size();
  returns_ += slice.returns;
  encode_time_ += encode_time;
  last_encode_time_ = encode_time;
  last_.step_m = slice.step_m;
  last_.error_m = slice.error_m;
  last_result_ = result;
}

void EncStats::OnErrorCheck(const PointErrors& errors, bool holds) {
  ++error_checks_;
  if (!holds) ++error_checks_failed_;
  points_checked_ += errors.points;
  largest_error_m_ = std::max(largest_error_m_, errors.max_m);
  sum_of_errors_m_ += errors.mean_m * static_cast<double>(errors.points);
}

GstStructure* EncStats::ToStructure(guint target_bps) const {
  const double bits = 8 * static_cast<double>(bytes_);
  return gst_structure_new(
      "dracoenc-stats", "scans-in", G_TYPE_UINT64, scans_in_, "scans-encoded", G_TYPE_UINT64,
      scans_encoded_, "scans-skipped", G_TYPE_UINT64, scans_skipped_, "slices", G_TYPE_UINT64,
      slices_, "slices-skipped", G_TYPE_UINT64, slices_skipped_, "slices-empty", G_TYPE_UINT64,
      slices_empty_, "slices-out-of-reach", G_TYPE_UINT64, out_of_reach_, "bytes", G_TYPE_UINT64,
      bytes_, "returns", G_TYPE_UINT64, returns_, "bits-per-return", G_TYPE_DOUBLE,
      returns_ > 0 ? bits / static_cast<double>(returns_) : 0.0, "step", G_TYPE_DOUBLE,
      last_.step_m, "error-bound", G_TYPE_DOUBLE, last_.error_m, "intensity-bits", G_TYPE_UINT,
      last_result_.intensity_bits, "keep-fraction", G_TYPE_DOUBLE, last_result_.keep_fraction,
      "target-bitrate", G_TYPE_UINT, target_bps, "bitrate", G_TYPE_UINT,
      static_cast<guint>(bitrate_), "encode-time", G_TYPE_UINT64, last_encode_time_,
      "mean-encode-time", G_TYPE_UINT64, slices_ > 0 ? encode_time_ / slices_ : 0, "error-checks",
      G_TYPE_UINT64, error_checks_, "error-checks-failed", G_TYPE_UINT64, error_checks_failed_,
      "largest-error", G_TYPE_DOUBLE, largest_error_m_, "mean-error", G_TYPE_DOUBLE,
      points_checked_ > 0 ? sum_of_errors_m_ / static_cast<double>(points_checked_) : 0.0, nullptr);
}

}  // namespace lidar::gst
