// SPDX-License-Identifier: LGPL-2.1-or-later
// Keeps the model's error in each sector of the last scan, to correct this scan.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

namespace lidar::rate {

/// An observation: at log step `x` the log size was `residual` above the fit.
struct Anchor {
  double x = 0;
  double residual = 0;
};

/// Sector i of a scan resembles sector i of the last scan most. Predictions add the common change
/// of the sectors since then, which comes from a turn of the vehicle or a wrong slope.
class SliceTracker {
 public:
  /// Returns the observation from which a slice is predicted; nothing before the first one.
  std::optional<Anchor> Predict(std::uint32_t slice_index, std::uint32_t slice_count) const;
  /// `error`: observed minus predicted.
  void Observe(std::uint32_t slice_index, std::uint32_t slice_count, Anchor anchor, double error);
  /// Replaces a slice's first encoding by its second.
  void Replace(std::uint32_t slice_index, std::uint32_t slice_count, Anchor anchor);

 private:
  std::vector<std::optional<Anchor>> sectors_;
  std::optional<Anchor> last_;
  double drift_ = 0;  // smoothed innovation of the latest slices
};

}  // namespace lidar::rate
