// SPDX-License-Identifier: LGPL-2.1-or-later
// Remembers how far each sector of the last scan was from the model, to correct this scan's.
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

/// Sector i of a scan looks most like sector i of the scan before. On top comes what the sectors
/// since then had in common: a turn of the vehicle, a wrong slope.
class SliceTracker {
 public:
  /// The observation to start from for a slice; nothing before the first one.
  std::optional<Anchor> Predict(std::uint32_t slice_index, std::uint32_t slice_count) const;
  /// `error`: observed minus what Predict() led to expect.
  void Observe(std::uint32_t slice_index, std::uint32_t slice_count, Anchor anchor, double error);
  /// Puts a re-encoded slice in place of its first encoding.
  void Replace(std::uint32_t slice_index, std::uint32_t slice_count, Anchor anchor);

 private:
  std::vector<std::optional<Anchor>> sectors_;
  std::optional<Anchor> last_;
  double drift_ = 0;  // smoothed innovation of the latest slices
};

}  // namespace lidar::rate
