// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs a rate controller on real slices with a moving target.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "src/rate/rate_controller.h"
#include "src/tools/lab/codec_lab/slice_codec.h"

namespace lidar::tools {

enum class TargetProfile { kSteady, kWalk, kJump };

struct ProfileOptions {
  double steady_bps = 0;
  double min_bps = 0;  // limits of walks and jumps
  double max_bps = 0;
  std::uint64_t seed = 1;
};

/// Returns the target for each scan [bit/s]. kSteady is a constant rate, and kWalk is a random walk
/// of 8 % per scan. kJump changes every 10 scans to a random rate between the limits, whose
/// logarithm is uniform.
std::vector<double> MakeTargets(TargetProfile profile, std::size_t scans,
                                const ProfileOptions& options);
/// Reads lines of `time_s rate_mbps`. Each scan gets the rate that holds at the start of the scan.
/// Throws std::runtime_error if the file is wrong.
std::vector<double> ReadTargets(const std::string& path, double scans_per_second);

struct TrackOptions {
  const CodingMode* mode = nullptr;
  double max_error_m = 0.02;
  unsigned intensity_bits = 0;
  std::uint32_t slices = 8;
  rate::DegradationPreference degradation = rate::DegradationPreference::kMaintainAccuracy;
  bool open_loop = false;
};

/// What the rate controller has done with a scan.
struct TrackedScan {
  double target_bps = 0;
  double sent_bps = 0;
  double coarsest_step_m = 0;
  double largest_bound_m = 0;  // error bound of the worst slice in the scan
  double min_bps = 0;          // the controller's r_min after this scan
  unsigned intensity_bits = 0;
  double keep_fraction = 1;
  bool skipped = false;
  unsigned reencoded = 0;
  double Error() const { return sent_bps / target_bps - 1; }
};

/// Returns the i-th number of a sequence that goes forwards and backwards in turn, such as 0 1 2 1
/// 0 1 2 ... for a count of 3.
std::size_t ThereAndBack(std::size_t i, std::size_t count);

/// Encodes a scan for each target. Plays the scans of `set` forwards and backwards in turn, so that
/// consecutive scans are always neighbours.
std::vector<TrackedScan> Track(const ScanSet& set, const std::vector<double>& targets,
                               const TrackOptions& options, std::unique_ptr<rate::SizeModel> model);

/// Returns the bitrates that the error bound and the sensor's resolution allow for a scan of `set`.
rate::RateBounds MeasureBounds(const ScanSet& set, const TrackOptions& options,
                               std::size_t scan = 0);
/// Returns the mean of |min_bps / real r_min - 1| over the scans that were sent. The first `settle`
/// scans do not count.
double MinimumError(const ScanSet& set, const TrackOptions& options,
                    const std::vector<TrackedScan>& scans, std::size_t settle);

struct TrackSummary {
  double mean = 0;           // mean of |error|
  double percentile_95 = 0;  // 95th percentile of |error|
  double largest_over = 0;   // error of the scan that exceeds its target by most
  double reencoded = 0;      // share of the slices that were encoded twice
  std::size_t skipped = 0;
  double largest_bound_m = 0;
};
/// Summarises the results of `scans`. The first `settle` scans do not count.
TrackSummary Summarise(const std::vector<TrackedScan>& scans, std::size_t settle,
                       std::uint32_t slices);

}  // namespace lidar::tools
