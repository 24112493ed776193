// SPDX-License-Identifier: LGPL-2.1-or-later
// Finds the beam that measured a point.
#pragma once
#include <cstdint>
#include <vector>

#include "src/codec/cloud/beam_table.h"

namespace lidar::codec::cloud {

class BeamLocator {
 public:
  struct Found {
    std::uint32_t beam = 0;
    double along_m = 0;  // position of the point along the beam
    double above_m = 0;  // height of the point above the beam
  };

  explicit BeamLocator(const BeamTable& table);

  /// Returns the beam that is nearest to the point.
  Found Find(const Sighting& s) const {
    const std::uint32_t guess =
        buckets_[BucketOf(s.z_m - middle_height_m_, std::max(s.rho_m, 1e-6))];
    const bool is_far = s.rho_m > far_m_[guess];
    const std::uint32_t around = is_far ? 0 : around_;
    const std::uint32_t first = guess < around ? 0 : guess - around;
    const std::uint32_t end =
        std::min(guess + around + 2, static_cast<std::uint32_t>(lines_.size()));
    std::uint32_t best = first;
    double least = std::abs(AboveOf(first, s));
    // This form compiles without branches, which would often be mispredicted.
    for (std::uint32_t i = first + 1; i < end; ++i) {
      const double above = std::abs(AboveOf(i, s));
      best = above < least ? i : best;
      least = std::min(above, least);
    }
    return On(best, s);
  }
  Found On(std::uint32_t beam, const Sighting& s) const {
    const Line& line = lines_[beam];
    const double z = s.z_m - line.height_m;
    return {beam, s.rho_m * line.cosine + z * line.sine - line.reach_m, AboveOf(beam, s)};
  }

 private:
  struct Line {
    double cosine;
    double sine;
    double height_m;
    double reach_m;
  };
  static constexpr std::uint32_t kBuckets = 8'192;

  double AboveOf(std::uint32_t beam, const Sighting& s) const {
    const Line& line = lines_[beam];
    return (s.z_m - line.height_m) * line.cosine - s.rho_m * line.sine;
  }
  /// Returns the bucket of a direction. It is computed from a quotient that rises with the
  /// elevation, from -1 to 1.
  static std::uint32_t BucketOf(double z, double rho) {
    return static_cast<std::uint32_t>((1 - z / (rho + std::abs(z))) * (0.4999 * kBuckets));
  }

  double FarFrom(std::uint32_t guess) const;

  std::vector<Line> lines_;
  double middle_height_m_ = 0;
  std::uint32_t around_ = 0;            // beams on each side of the guess that may be nearer
  std::vector<std::uint16_t> buckets_;  // the last beam above each bucket
  std::vector<double> far_m_;           // FarFrom() of each guess
};

}  // namespace lidar::codec::cloud
