// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the shapes that a ray can meet. These are the shapes in the ray's sector of azimuth, sorted
// by distance.
#pragma once
#include <cstdint>
#include <vector>

#include "src/synth/shapes.h"

namespace lidar::synth {

/// Returns a number that grows with the angle of (x, y), from 0 to 4 in a whole turn. This costs
/// less than atan2().
inline float PseudoAngle(float x, float y) {
  const float p = y / (std::abs(x) + std::abs(y) + 1e-30F);
  return x < 0 ? 2 - p : (p < 0 ? 4 + p : p);
}

/// An index of shapes by sectors of azimuth. It is valid while the sensor stays within `margin` of
/// `origin` (see Build()), which is only the case for a short part of a sweep.
class SectorIndex {
 public:
  struct Entry {
    float nearest;    // horizontal distance to the shape's nearest point [m]
    float min_slope;  // least slope of the rays that can meet the shape
    float max_slope;
    std::uint32_t shape;
  };
  struct Range {
    const Entry* first;
    const Entry* last;
    const Entry* begin() const { return first; }
    const Entry* end() const { return last; }
  };
  /// An arc of pseudo-angles. It may extend beyond 4. If `width` is 4 or more, it is a full circle.
  struct Arc {
    float start = 0;
    float width = 0;
  };

  /// Sorts the shapes that are seen from `origin` into the sectors of `arc`.
  void Build(const std::vector<Shape>& shapes, Vec3 origin, float margin, Arc arc);
  Range Find(float pseudo_angle) const {
    const auto sector = static_cast<std::size_t>(pseudo_angle * kSectorsPerUnit) % kSectors;
    return {entries_.data() + starts_[sector], entries_.data() + starts_[sector + 1]};
  }

 private:
  static constexpr std::size_t kSectors = 512;
  static constexpr float kSectorsPerUnit = kSectors / 4.0F;
  struct Candidate {
    Entry entry;
    std::uint32_t first_sector;
    std::uint32_t sectors;
  };

  void AddCandidate(const Shape& shape, std::uint32_t index, Vec3 origin, float margin, Arc arc);
  void FillSectors();

  std::vector<Candidate> candidates_;
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> starts_ = std::vector<std::uint32_t>(kSectors + 1, 0);
  std::vector<std::uint32_t> next_;
};

}  // namespace lidar::synth
