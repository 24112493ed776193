// SPDX-License-Identifier: LGPL-2.1-or-later
// The shapes that a ray can meet: those in its sector of azimuth, nearest first.
#pragma once
#include <cstdint>
#include <vector>

#include "src/synth/shapes.h"

namespace lidar::synth {

/// Grows with the angle of (x, y) as atan2 does, without its cost: [0, 4) instead of a turn.
inline float PseudoAngle(float x, float y) {
  const float p = y / (std::abs(x) + std::abs(y) + 1e-30F);
  return x < 0 ? 2 - p : (p < 0 ? 4 + p : p);
}

/// Valid while the sensor stays within `margin` of one place, so for a short part of a sweep.
class SectorIndex {
 public:
  struct Entry {
    float nearest;    // horizontal distance of its nearest corner [m]
    float min_slope;  // least slope of rays that can meet it
    float max_slope;
    std::uint32_t shape;
  };
  struct Range {
    const Entry* first;
    const Entry* last;
    const Entry* begin() const { return first; }
    const Entry* end() const { return last; }
  };
  /// An arc in pseudo-angles; it may pass 4, and goes around when `width` is 4 or more.
  struct Arc {
    float start = 0;
    float width = 0;
  };

  /// Sorts the shapes seen from `origin` into the sectors of `arc`.
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
