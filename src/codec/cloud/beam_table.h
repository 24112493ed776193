// SPDX-License-Identifier: LGPL-2.1-or-later
// Directions of the beams of a spinning sensor, found in the points of its clouds.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/base/byte_writer.h"
#include "src/codec/cloud/beam_path.h"
#include "src/codec/cloud/cell_cover.h"

namespace lidar::codec::cloud {

/// Angles are in 2^-22 turns: half a unit moves a point at 200 m by 0.15 mm.
constexpr unsigned kTurnBits = 22;
constexpr std::int32_t kTurn = 1 << kTurnBits;
constexpr double kRadians = 2 * M_PI / kTurn;

/// A point as the sensor at the origin sees it.
struct Sighting {
  Sighting() = default;
  explicit Sighting(const Point& point);
  double range_m = 0;
  double rho_m = 0;  // range along the ground
  double z_m = 0;
  std::int32_t azimuth = 0;  // counter-clockwise, below kTurn
};
/// Converts the first `count` points.
void SightAll(const std::vector<Point>& points, std::size_t count,
              std::vector<Sighting>* sightings);

/// Returns what std::atan2(y, x) does, in a quarter of its time.
double AngleOf(double y, double x);

/// The points of a beam lie on a line in the plane of `rho` and z: one point in each column of a
/// turn, at the azimuth of the column. A beam that passes the origin at a distance adds an angle to
/// the azimuth. Points of bending beams are only near the line.
struct BeamTable {
  static constexpr std::uint32_t kMostPeriod = 4;
  struct Beam {
    std::int32_t elevation = 0;
    std::int32_t offset = 0;     // azimuth of column 0
    std::int32_t height_um = 0;  // of the line above the origin
    std::int32_t side_um = 0;    // distance at which it passes the origin, to the left
    std::array<std::int32_t, kMostPeriod>
        swings{};               // added to azimuths, by the firing modulo `period`
    std::int32_t reach_um = 0;  // position of range 0 along the beam
    std::uint32_t delay = 0;    // delay of the beam in columns; below columns()

    bool Swings() const { return swings != decltype(swings){}; }
  };
  static constexpr std::uint32_t kParts = 256;
  static constexpr std::uint32_t kMostBeams = 1'024;
  static constexpr std::uint32_t kMostColumns = 16'384;
  static constexpr std::int32_t kMostOffsetUm = 1'000'000;
  static constexpr std::int32_t kLengthUnitUm = 50;  // of heights, sides and reaches
  static constexpr std::uint32_t kMostGrains = 1U << 18;
  /// Unit of swings: 0.0014 degrees.
  static constexpr std::int32_t kSwingUnit = 16;
  /// Unit of the elevations and offsets of bending beams. Residuals of the points add the rest.
  static constexpr std::int32_t kBentElevation = 128;
  static constexpr std::int32_t kBentOffset = 32;

  std::uint32_t turn = 0;             // columns of a turn, in 1/kParts
  std::uint32_t period = 1;           // of the swings; 1: no swings
  std::vector<Beam> beams;            // top to bottom
  std::uint32_t grains = 0;           // number in a turn; 0: the columns have equal steps
  std::vector<std::uint32_t> places;  // of the columns, in grains, rising
  bool bends = false;                 // each point has its own elevation
  bool beams_follow = true;           // CodeBeams() codes the beams; false: an old table has them
  // A table with a path uses only these fields.
  std::int32_t rate = 0;       // of the turn, for BeamPath; 0: no path
  std::vector<PathBeam> path;  // as many as beams

  std::uint32_t columns() const { return (turn + kParts - 1) / kParts; }
  std::uint32_t rows() const { return static_cast<std::uint32_t>(beams.size()); }
  bool has_offsets() const;
  bool has_path() const { return rate != 0; }
  /// Step of the columns, in units.
  std::int32_t step() const {
    return has_path() ? std::abs(rate) >> BeamPath::kRateBits
                      : static_cast<std::int32_t>(std::uint64_t{kTurn} * kParts / turn);
  }
  /// Index of the firing in which a beam sees a column.
  std::uint32_t FiringOf(std::uint32_t beam, std::uint32_t column) const {
    column += beams[beam].delay;
    return column >= columns() ? column - columns() : column;
  }
  /// Column in which a beam sees a firing.
  std::uint32_t ColumnOf(const Beam& beam, std::uint32_t firing) const {
    return firing >= beam.delay ? firing - beam.delay : firing + columns() - beam.delay;
  }
  /// Returns the azimuth without wrapping. Do not call it for a table with a path.
  std::int32_t AzimuthOf(std::uint32_t beam, std::uint32_t column) const {
    column = FiringOf(beam, column);
    const std::uint64_t angle = places.empty() ? std::uint64_t{column} * kParts * kTurn / turn
                                               : std::uint64_t{places[column]} * kTurn / grains;
    std::int32_t azimuth = beams[beam].offset + static_cast<std::int32_t>(angle);
    if (period > 1) azimuth += beams[beam].swings[column % period];
    return azimuth;
  }
  /// Cosine and sine of an angle [units].
  struct Slope {
    explicit Slope(double angle);
    double cosine;
    double sine;
  };
  Point At(std::uint32_t beam, std::int32_t azimuth, const Slope& slope,
           std::uint32_t range_mm) const;

  /// Writes all but the beams, the places and the curves.
  void Write(ByteWriter* writer) const;
  /// Returns nothing for numbers that no encoder writes. Parts that come later in the stream are 0:
  /// beams, places if there are grains, and curves on a path.
  static std::optional<BeamTable> Read(ByteReader* reader);
};

/// Returns the angle that a beam beside the origin adds to the azimuth of a point.
inline double SideAngle(const BeamTable::Beam& beam, double rho_m) {
  constexpr double kUnits = 1e-6 / kRadians;
  return beam.side_um == 0 ? 0 : kUnits * beam.side_um / std::max(rho_m, 1e-3);
}

/// Wraps an angle to -kTurn / 2 to kTurn / 2.
inline std::int32_t Wrapped(std::int32_t angle) {
  return ((angle + kTurn / 2) & (kTurn - 1)) - kTurn / 2;
}

/// Rounds like std::lround(), without a call or a jump.
inline std::int32_t ToNearest(double value) {
  return static_cast<std::int32_t>(value + std::copysign(0.5, value));
}

/// Computes the azimuths of a table's pixels without a division for each.
class ColumnAngles {
 public:
  explicit ColumnAngles(const BeamTable& table);
  /// Returns what BeamTable::AzimuthOf() does, less the offset of the beam, modulo a turn.
  std::int32_t Of(std::uint32_t beam, std::uint32_t column) const {
    const std::uint32_t firing = table_.FiringOf(beam, column);
    if (table_.period == 1) return angles_[firing];
    return angles_[firing] + table_.beams[beam].swings[firing % table_.period];
  }
  /// Angles of the firings, without swings.
  const std::vector<std::int32_t>& firings() const { return angles_; }

 private:
  const BeamTable& table_;
  std::vector<std::int32_t> angles_;
};

/// Finds the column of an azimuth.
class ColumnFinder {
 public:
  /// A column, and the distance of the azimuth from it.
  struct Found {
    std::uint32_t column = 0;
    std::int32_t residual = 0;
  };
  explicit ColumnFinder(const BeamTable& table);
  /// Returns the column with the nearest azimuth. `azimuth` is without the offset of the beam.
  Found Find(std::uint32_t beam, std::int32_t azimuth) const;

 private:
  Found NearestOf(const BeamTable::Beam& beam, std::uint32_t first, std::int32_t away) const;

  static constexpr unsigned kShift = kTurnBits - 14;  // to buckets
  const BeamTable& table_;
  ColumnAngles angles_;
  std::vector<std::int32_t> around_;    // angles of the last firing, all firings and the first two
  std::vector<std::uint16_t> buckets_;  // first firing from each bucket on; empty: equal steps
  std::vector<bool> swings_;            // has the beam swings?
};

}  // namespace lidar::codec::cloud
