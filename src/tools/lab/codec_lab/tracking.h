// SPDX-License-Identifier: LGPL-2.1-or-later
// A rate controller on real slices and a moving target.
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

/// Targets for each scan [bit/s]: a constant rate; a random walk of 8 % a scan; jumps every 10
/// scans to anywhere in the range, uniformly in the logarithm.
std::vector<double> MakeTargets(TargetProfile profile, std::size_t scans,
                                const ProfileOptions& options);
/// Reads lines of `time_s rate_mbps`; a scan takes the rate that holds at its start. Throws.
std::vector<double> ReadTargets(const std::string& path, double scans_per_second);

struct TrackOptions {
  const CodingMode* mode = nullptr;
  double max_error_m = 0.02;
  unsigned intensity_bits = 0;
  std::uint32_t slices = 8;
  rate::DegradationPreference degradation = rate::DegradationPreference::kMaintainAccuracy;
  bool open_loop = false;
};

/// The result of a scan.
struct TrackedScan {
  double target_bps = 0;
  double sent_bps = 0;
  double coarsest_step_m = 0;
  double largest_bound_m = 0;  // error bound of its worst slice
  double min_bps = 0;          // the controller's r_min after this scan
  unsigned intensity_bits = 0;
  double keep_fraction = 1;
  bool skipped = false;
  unsigned reencoded = 0;
  double Error() const { return sent_bps / target_bps - 1; }
};

/// 0 1 2 1 0 1 2 ... for a count of 3.
std::size_t ThereAndBack(std::size_t i, std::size_t count);

/// Plays `set` forwards and backwards in turn, so that consecutive scans are neighbours.
std::vector<TrackedScan> Track(const ScanSet& set, const std::vector<double>& targets,
                               const TrackOptions& options, std::unique_ptr<rate::SizeModel> model);

/// Bitrates that the error bound and the sensor's resolution allow for a scan of the source.
rate::RateBounds MeasureBounds(const ScanSet& set, const TrackOptions& options,
                               std::size_t scan = 0);
/// Mean of |min_bps / real r_min - 1| over the scans that were sent, without the first `settle`.
double MinimumError(const ScanSet& set, const TrackOptions& options,
                    const std::vector<TrackedScan>& scans, std::size_t settle);

struct TrackSummary {
  double mean = 0;           // of |error|
  double percentile_95 = 0;  // of |error|
  double largest_over = 0;   // error of the scan furthest above its target
  double reencoded = 0;      // share of the slices
  std::size_t skipped = 0;
  double largest_bound_m = 0;
};
/// Leaves out the first `settle` scans.
TrackSummary Summarise(const std::vector<TrackedScan>& scans, std::size_t settle,
                       std::uint32_t slices);

}  // namespace lidar::tools
