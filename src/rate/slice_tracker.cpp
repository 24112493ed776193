// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rate/slice_tracker.h"

namespace lidar::rate {
namespace {

constexpr double kDriftGain = 0.3;
constexpr double kDriftWeight = 0.7;

}  // namespace

std::optional<Anchor> SliceTracker::Predict(std::uint32_t slice_index,
                                            std::uint32_t slice_count) const {
  if (sectors_.size() != slice_count || slice_index >= slice_count || !sectors_[slice_index])
    return last_;
  Anchor anchor = *sectors_[slice_index];
  anchor.residual += kDriftWeight * drift_;
  return anchor;
}

void SliceTracker::Observe(std::uint32_t slice_index, std::uint32_t slice_count, Anchor anchor,
                           double error) {
  if (sectors_.size() != slice_count) {
    sectors_.assign(slice_count, std::nullopt);
    drift_ = 0;
  }
  last_ = anchor;
  if (slice_index >= slice_count) return;
  // If scans have only one slice, no drift is tracked, because the innovation is then the noise of
  // this slice.
  if (sectors_[slice_index] && slice_count > 1) {
    const double innovation = error + kDriftWeight * drift_;
    drift_ += kDriftGain * (innovation - drift_);
  }
  sectors_[slice_index] = anchor;
}

void SliceTracker::Replace(std::uint32_t slice_index, std::uint32_t slice_count, Anchor anchor) {
  last_ = anchor;
  if (sectors_.size() == slice_count && slice_index < slice_count) sectors_[slice_index] = anchor;
}

}  // namespace lidar::rate
