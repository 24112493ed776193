// SPDX-License-Identifier: LGPL-2.1-or-later
// The paths of beams, for sensors whose scans do not repeat. Each beam follows its own curves.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace lidar::codec::cloud {

/// The degrees of the polynomials in a curve. A curve is the sum of a polynomial, of two
/// polynomials that are multiplied by the cosine and the sine of the turn, and of two polynomials
/// that are multiplied by the cosine and the sine of twice the turn.
constexpr std::array<unsigned, 3> kPathDegrees = {15, 7, 3};
constexpr unsigned kPathTerms = 40;
constexpr std::uint32_t kMostPathBeams = 16;

/// The factors of a curve's terms, in units of kPathUnit.
using PathCurve = std::array<std::int32_t, kPathTerms>;
constexpr std::int32_t kPathUnit = 4;

/// The two curves of a beam: the angle that is added to the azimuth of the turn, and the elevation.
struct PathBeam {
  PathCurve azimuth{};
  PathCurve elevation{};
};

struct PathDirection {
  std::int32_t azimuth = 0;  // not wrapped
  std::int32_t elevation = 0;
};

class BeamPath {
 public:
  static constexpr unsigned kRateBits = 11;
  static constexpr std::int32_t kMostRate = (1 << 27) - 1;

  /// The azimuth of the turn changes by `rate` from one column to the next.
  BeamPath(std::int32_t rate, std::uint32_t columns) : rate_(rate), columns_(columns) {}

  using Terms = std::array<double, kPathTerms>;
  Terms TermsAt(std::uint32_t column) const;
  /// Returns the azimuth of the turn, without curves and not wrapped.
  std::int64_t TurnAt(std::uint32_t column) const {
    return std::int64_t{rate_} * column >> kRateBits;
  }
  /// Returns the directions of `count` columns, beginning with column `first`, beam by beam.
  std::vector<PathDirection> Trace(const std::vector<PathBeam>& beams, std::uint32_t first,
                                   std::uint32_t count) const;

 private:
  std::int32_t rate_;  // per column, in 1/2^kRateBits of an angle unit
  std::uint32_t columns_;
};

}  // namespace lidar::codec::cloud
