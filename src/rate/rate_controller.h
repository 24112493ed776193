// SPDX-License-Identifier: LGPL-2.1-or-later
// Divides a target bitrate among slices. Each slice gets a budget and settings, and may be encoded
// a second time.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>

#include "src/base/units.h"
#include "src/rate/demand_table.h"
#include "src/rate/scan_plan.h"
#include "src/rate/size_model.h"

namespace lidar::rate {

struct ControllerParameters {
  /// The limits of the settings. `coarsest_step_m` is the coarsest step within max-error (see
  /// ErrorBound), so max-error holds at any target bitrate.
  SettingLimits limits;
  /// The controller lowers the intensity bits to this number before it skips scans or thins them.
  unsigned min_intensity_bits = 4;
  DegradationPreference degradation = DegradationPreference::kMaintainAccuracy;
  /// If false, the loop is open as in the paper: no bytes are carried over to later scans, and no
  /// slice is encoded a second time.
  bool closed_loop = true;
};

/// The decision for a slice.
struct Decision {
  bool skip = false;  // leave the slice out, and send a gap
  Settings settings;
  double keep_fraction = 1;        // below 1: code only what ThinningPattern() keeps
  std::optional<DataSize> budget;  // empty: constant quality
};

/// The bounds of the media bitrate, for the event `bitrate-bounds`.
struct RateBounds {
  DataRate min;      // at the coarsest step that the error allows, with the fewest intensity bits
  DataRate nominal;  // at the coarsest step, with all intensity bits
  DataRate max;      // at the finest useful step
};

struct ControllerStats {
  std::uint64_t slices = 0;
  std::uint64_t slices_reencoded = 0;
  std::uint64_t slices_skipped = 0;
  std::uint64_t scans_skipped = 0;
  std::uint64_t scans_thinned = 0;
  double saved_bytes = 0;  // carried over; negative: a debt
};

/// Decides how slices are encoded. For each slice, call NextSlice(), encode the slice, and call
/// OnEncoded(). If OnEncoded() returns settings, encode the slice once more with these settings,
/// and call OnEncoded() again. Not thread-safe.
class RateController {
 public:
  RateController(ControllerParameters parameters, std::unique_ptr<SizeModel> model);

  /// Sets the bitrate of the encoded slices, without transport overhead. Without a target, the
  /// quality is constant, at the coarsest step.
  void SetTarget(std::optional<DataRate> target);
  /// Sets the parameters for the next slices.
  void SetParameters(const ControllerParameters& parameters) { parameters_ = parameters; }

  Decision NextSlice(const SliceFeatures& slice);
  /// Returns settings if the slice should be encoded a second time. Returns nothing if it should be
  /// sent as it is.
  std::optional<Settings> OnEncoded(const EncodedSize& encoded);

  /// Returns the bounds of the media bitrate. They are 0 before the first slice.
  RateBounds bounds() const;
  /// Returns the bounds if one of them has changed by more than 3 % since they were last returned.
  /// Returns them at most once per scan, after the last slice of the scan.
  std::optional<RateBounds> TakeChangedBounds();
  const ControllerStats& stats() const { return stats_; }

 private:
  void StartScan();
  void UpdateDemand();
  double SliceBudget() const;
  double ScanBudget() const;
  void Settle(double bytes);

  ControllerParameters parameters_;
  std::unique_ptr<SizeModel> model_;
  std::optional<DataRate> target_;

  SliceFeatures slice_;
  Decision decision_;
  bool pending_ = false;    // NextSlice() was called, but OnEncoded() not yet
  bool reencoded_ = false;  // the slice is being encoded a second time
  bool started_ = false;
  bool measured_ = false;
  DemandTable demand_;
  ScanPlan plan_;
  double saved_ = 0;   // bytes saved in earlier scans
  double repay_ = 0;   // part of saved_ that this scan spends or repays
  double ledger_ = 0;  // this scan's share of the target so far, minus the bytes sent
  bool bounds_due_ = false;
  RateBounds bounds_taken_;
  ControllerStats stats_;
};

}  // namespace lidar::rate
