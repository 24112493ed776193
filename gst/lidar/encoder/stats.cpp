// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/lidar/encoder/stats.h"

#include <algorithm>

#include "gst/common/stats.h"

namespace lidar::gst {
namespace {

using Counters = EncoderStats::Counters;

gdouble BitsPerReturn(const Counters& c) {
  return c.returns > 0 ? 8 * static_cast<gdouble>(c.bytes) / static_cast<gdouble>(c.returns) : 0;
}
guint64 MeanEncodeTime(const Counters& c) { return c.slices > 0 ? c.encode_time / c.slices : 0; }
gdouble MeanError(const Counters& c) {
  return c.points_checked > 0 ? c.sum_of_errors_m / static_cast<gdouble>(c.points_checked) : 0;
}
std::string LastMode(const Counters& c) { return c.last.mode; }
gdouble LastStep(const Counters& c) { return c.last.slice.step_m; }
gdouble LastErrorBound(const Counters& c) { return c.last.slice.error_m; }
guint LastIntensityBits(const Counters& c) { return c.last.intensity_bits; }
gdouble LastKeepFraction(const Counters& c) { return c.last.keep_fraction; }
guint Bitrate(const Counters& c) { return static_cast<guint>(MIN(c.bitrate, gdouble{G_MAXUINT})); }

const std::array<Stat<Counters>, 24> kStats = {{
    {"scans-in", &Counters::scans_in},
    {"scans-encoded", &Counters::scans_encoded},
    {"scans-skipped", &Counters::scans_skipped},
    {"slices", &Counters::slices},
    {"slices-skipped", &Counters::slices_skipped},
    {"slices-empty", &Counters::slices_empty},
    {"slices-out-of-reach", &Counters::slices_out_of_reach},
    {"bytes", &Counters::bytes},
    {"returns", &Counters::returns},
    {"bits-per-return", BitsPerReturn},
    {"mode", LastMode},
    {"step", LastStep},
    {"error-bound", LastErrorBound},
    {"intensity-bits", LastIntensityBits},
    {"keep-fraction", LastKeepFraction},
    {"target-bitrate", &Counters::target_bps},
    {"bitrate", Bitrate},
    {"encode-time", &Counters::last_encode_time},
    {"mean-encode-time", MeanEncodeTime},
    {"error-checks", &Counters::error_checks},
    {"error-checks-failed", &Counters::error_checks_failed},
    {"points-checked", &Counters::points_checked},
    {"largest-error", &Counters::largest_error_m},
    {"mean-error", MeanError},
}};

}  // namespace

void EncoderStats::OnScan(double scans_per_second) {
  if (counters_.scans_in > 0) CloseScan();
  scans_per_second_ = scans_per_second;
  ++counters_.scans_in;
}

void EncoderStats::CloseScan() {
  constexpr double kGain = 0.1;
  const double rate = 8 * static_cast<double>(scan_bytes_) * scans_per_second_;
  counters_.bitrate += (counters_.scans_in == 1 ? 1 : kGain) * (rate - counters_.bitrate);
  scan_bytes_ = 0;
  scan_has_slices_ = false;
  scan_was_skipped_ = false;
}

void EncoderStats::OnSlice(const rate::LoopResult& result, GstClockTime encode_time) {
  Counters& c = counters_;
  if (result.skipped) {
    ++c.slices_skipped;
    if (!scan_was_skipped_) ++c.scans_skipped;
    scan_was_skipped_ = true;
    return;
  }
  if (result.result == rate::CodingResult::kEmpty) ++c.slices_empty;
  if (result.result == rate::CodingResult::kOutOfReach) ++c.slices_out_of_reach;
  if (!result.encoded()) return;
  if (!scan_has_slices_) ++c.scans_encoded;
  scan_has_slices_ = true;
  ++c.slices;
  c.bytes += result.slice.bytes;
  scan_bytes_ += result.slice.bytes;
  c.returns += result.slice.returns;
  c.encode_time += encode_time;
  c.last_encode_time = encode_time;
  c.last = result;
}

void EncoderStats::OnErrorCheck(const PointErrors& errors, bool holds) {
  Counters& c = counters_;
  ++c.error_checks;
  if (!holds) ++c.error_checks_failed;
  c.points_checked += errors.points;
  c.largest_error_m = std::max(c.largest_error_m, errors.max_m);
  c.sum_of_errors_m += errors.mean_m * static_cast<double>(errors.points);
}

StructurePtr EncoderStats::ToStructure(guint target_bps) const {
  Counters counters = counters_;
  counters.target_bps = target_bps;
  return gst::ToStructure("lidar-encoder-stats", kStats, counters);
}

}  // namespace lidar::gst
