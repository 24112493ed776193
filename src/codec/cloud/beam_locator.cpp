// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/beam_locator.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lidar::codec::cloud {

BeamLocator::BeamLocator(const BeamTable& table) {
  for (const BeamTable::Beam& beam : table.beams) {
    const double elevation = beam.elevation * kRadians;
    lines_.push_back(
        {std::cos(elevation), std::sin(elevation), 1e-6 * beam.height_um, 1e-6 * beam.reach_um});
    middle_height_m_ += lines_.back().height_m / static_cast<double>(table.rows());
  }
  constexpr std::uint32_t kAround = 3;
  if (table.has_offsets()) around_ = kAround;
  // Each bucket gets the last beam that is above its upper edge.
  buckets_.assign(kBuckets, 0);
  std::uint32_t next = 0;
  for (std::uint32_t beam = 0; beam < lines_.size(); ++beam) {
    const std::uint32_t at = BucketOf(lines_[beam].sine, std::max(lines_[beam].cosine, 1e-9));
    for (; next <= at; ++next)
      buckets_[next] = static_cast<std::uint16_t>(beam == 0 ? 0 : beam - 1);
  }
  for (; next < kBuckets; ++next) buckets_[next] = static_cast<std::uint16_t>(lines_.size() - 1);
  for (std::uint32_t beam = 0; beam < lines_.size(); ++beam) far_m_.push_back(FarFrom(beam));
}

/// Returns a distance along the ground. If a point with this guess is farther away, the line
/// nearest to the point is either line `guess` or the next one.
///
/// The slope of such a point, as seen from the middle height, is between the slopes of these two
/// lines, or below both by at most the width of a bucket.
double BeamLocator::FarFrom(std::uint32_t guess) const {
  const auto beams = static_cast<std::uint32_t>(lines_.size());
  constexpr double kNever = std::numeric_limits<double>::infinity();
  constexpr double kLeastCosine = 0.1;
  // Points above the first beam, or below the last one, may have any slope.
  if (guess == 0 || guess + 1 >= beams) return kNever;
  const std::uint32_t first = guess < around_ ? 0 : guess - around_;
  const std::uint32_t end = std::min(guess + around_ + 2, beams);
  for (std::uint32_t i = first; i < end; ++i)
    if (lines_[i].cosine < kLeastCosine) return kNever;
  const Line& upper = lines_[guess];
  const Line& lower = lines_[guess + 1];
  const double most = upper.sine / upper.cosine;
  const double edge = lower.sine / lower.cosine;
  const double width = 1.1 / (0.4999 * kBuckets) * (1 + std::abs(edge)) * (1 + std::abs(edge));
  // away() is for a point that is 1 m away along the ground. It is the distance of the point from a
  // line, if the line is moved to the middle height. off_m() is by how much the true height of the
  // line changes a distance.
  const auto away = [](const Line& line, double slope) { return slope * line.cosine - line.sine; };
  const auto off_m = [&](const Line& line) {
    return std::abs(line.height_m - middle_height_m_) * line.cosine;
  };
  double far_m = 0;
  const auto exclude = [&](const Line& line, const Line& nearer, double farther) {
    constexpr double kRoom = 1.01;
    const double bound = kRoom * (off_m(line) + off_m(nearer)) + 1e-6;
    far_m = farther > 1e-6 ? std::max(far_m, bound / farther) : kNever;
  };
  for (std::uint32_t i = first; i < guess && far_m < kNever; ++i)
    exclude(lines_[i], upper,
            std::min(away(upper, most) - away(lines_[i], most),
                     away(upper, edge - width) - away(lines_[i], edge - width)));
  for (std::uint32_t i = guess + 2; i < end && far_m < kNever; ++i)
    exclude(lines_[i], lower,
            std::min(away(lines_[i], most) - away(lower, most),
                     away(lines_[i], edge - width) - width * lower.cosine));
  return far_m;
}

}  // namespace lidar::codec::cloud
