// SPDX-License-Identifier: LGPL-2.1-or-later
// Keeps the error of the model in each sector of the last scan. The errors are used to correct the
// predictions for the current scan.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

namespace lidar::rate {

/// The observed size of a slice: at the log step `x`, the log size was `residual` above the fit.
struct Anchor {
  double x = 0;
  double residual = 0;
};

/// Predicts each slice from the slice that was observed in the same sector of the last scan,
/// because these two slices are most alike. Also predicts the change that all sectors have had
/// since then. Such a change is caused by a turn of the vehicle, or by a wrong slope of the model.
class SliceTracker {
 public:
  /// Returns the observation from which a slice is predicted, or nothing if there is none yet.
  std::optional<Anchor> Predict(std::uint32_t slice_index, std::uint32_t slice_count) const;
  /// Adds the observation of a slice. `error` is the observed log size minus the predicted one.
  void Observe(std::uint32_t slice_index, std::uint32_t slice_count, Anchor anchor, double error);
  /// Replaces the observation of a slice after it was encoded a second time.
  void Replace(std::uint32_t slice_index, std::uint32_t slice_count, Anchor anchor);

 private:
  std::vector<std::optional<Anchor>> sectors_;
  std::optional<Anchor> last_;
  double drift_ = 0;  // smoothed innovation of the latest slices
};

}  // namespace lidar::rate
