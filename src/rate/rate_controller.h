// SPDX-License-Identifier: LGPL-2.1-or-later
// Spends a target bitrate on slices: each gets a budget, settings, and at most one second encoding.
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
  /// `coarsest_step_m` comes from max-error (ErrorBound), so the error bound holds at any target.
  SettingLimits limits;
  /// The controller lowers the intensity bits to this before it skips or thins.
  unsigned min_intensity_bits = 4;
  DegradationPreference degradation = DegradationPreference::kMaintainAccuracy;
  /// false: the paper's open loop, without carry-over and second encoding.
  bool closed_loop = true;
};

/// The decision for a slice.
struct Decision {
  bool skip = false;  // leave the slice out, and send a gap
  Settings settings;
  double keep_fraction = 1;        // below 1: code only what ThinningPattern() keeps
  std::optional<DataSize> budget;  // empty: constant quality
};

/// Bitrates of media, for the event `bitrate-bounds`.
struct RateBounds {
  DataRate min;      // at the coarsest step that the error allows, least intensity bits
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

/// Call NextSlice(), encode the slice, and call OnEncoded(). If OnEncoded() returns settings,
/// encode once more and call it again. Not thread-safe.
class RateController {
 public:
  RateController(ControllerParameters parameters, std::unique_ptr<SizeModel> model);

  /// Bitrate for the encoded slices without transport overhead. Without a target: constant quality
  /// at the coarsest step.
  void SetTarget(std::optional<DataRate> target);
  /// Sets parameters from the next slice on.
  void SetParameters(const ControllerParameters& parameters) { parameters_ = parameters; }

  Decision NextSlice(const SliceFeatures& slice);
  /// Returns settings for a second encoding of the slice; nothing: the slice is sent as it is.
  std::optional<Settings> OnEncoded(const EncodedSize& encoded);

  /// Zero before the first slice.
  RateBounds bounds() const;
  /// Returns the bounds if one has moved by more than 3 % since they were last returned. Returns
  /// them at most once a scan, after its last slice.
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
  bool pending_ = false;    // NextSlice() was called, its OnEncoded() not yet
  bool reencoded_ = false;  // the slice gets its second encoding
  bool started_ = false;
  bool measured_ = false;
  DemandTable demand_;
  ScanPlan plan_;
  double saved_ = 0;   // bytes from scans before this one
  double repay_ = 0;   // part of saved_ that this scan spends or repays
  double ledger_ = 0;  // this scan's share of the target so far, minus the bytes sent
  bool bounds_due_ = false;
  RateBounds bounds_taken_;
  ControllerStats stats_;
};

}  // namespace lidar::rate
