// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/codec/cloud/beam_locator.h"

#include <algorithm>
#include <cmath>

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
  // Sets for each bucket the last beam above its upper edge.
  buckets_.assign(kBuckets, 0);
  std::uint32_t next = 0;
  for (std::uint32_t beam = 0; beam < lines_.size(); ++beam) {
    const std::uint32_t at = BucketOf(lines_[beam].sine, std::max(lines_[beam].cosine, 1e-9));
    for (; next <= at; ++next)
      buckets_[next] = static_cast<std::uint16_t>(beam == 0 ? 0 : beam - 1);
  }
  for (; next < kBuckets; ++next) buckets_[next] = static_cast<std::uint16_t>(lines_.size() - 1);
}

}  // namespace lidar::codec::cloud
