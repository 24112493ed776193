// SPDX-License-Identifier: LGPL-2.1-or-later
// Beams of sensors whose scans do not repeat. Each beam follows curves of its own.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace lidar::codec::cloud {

/// A curve is a sum of polynomials, multiplied by 1, by the cosine and the sine of the turn, and by
/// those of twice the turn. These are the degrees of the polynomials.
constexpr std::array<unsigned, 3> kPathDegrees = {15, 7, 3};
constexpr unsigned kPathTerms = 40;
constexpr std::uint32_t kMostPathBeams = 16;

/// Factors of the terms, in kPathUnit.
using PathCurve = std::array<std::int32_t, kPathTerms>;
constexpr std::int32_t kPathUnit = 4;

/// The two curves of a beam: of the angle that it adds to the azimuth of the turn, and of its
/// elevation.
struct PathBeam {
  PathCurve azimuth{};
  PathCurve elevation{};
};

struct PathDirection {
  std::int32_t azimuth = 0;  // without wrapping
  std::int32_t elevation = 0;
};

class BeamPath {
 public:
  static constexpr unsigned kRateBits = 11;
  static constexpr std::int32_t kMostRate = (1 << 27) - 1;

  /// Azimuths turn by `rate` a column.
  BeamPath(std::int32_t rate, std::uint32_t columns) : rate_(rate), columns_(columns) {}

  using Terms = std::array<double, kPathTerms>;
  Terms TermsAt(std::uint32_t column) const;
  /// Returns the azimuth without curves and wrapping.
  std::int64_t TurnAt(std::uint32_t column) const {
    return std::int64_t{rate_} * column >> kRateBits;
  }
  /// Returns the directions of `count` columns, beam by beam.
  std::vector<PathDirection> Trace(const std::vector<PathBeam>& beams, std::uint32_t first,
                                   std::uint32_t count) const;

 private:
  std::int32_t rate_;  // in 1/2^kRateBits units a column
  std::uint32_t columns_;
};

}  // namespace lidar::codec::cloud
