// SPDX-License-Identifier: LGPL-2.1-or-later
// The directions of a spinning sensor's beams. They are found in the points of its clouds.
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

/// Angles are in units of 2^-22 turns. Half a unit moves a point at 200 m by 0.15 mm.
constexpr unsigned kTurnBits = 22;
constexpr std::int32_t kTurn = 1 << kTurnBits;
constexpr double kRadians = 2 * M_PI / kTurn;

/// A point as seen by the sensor, which is at the origin.
struct Sighting {
  Sighting() = default;
  explicit Sighting(const Point& point);
  double range_m = 0;
  double rho_m = 0;  // range along the ground
  double z_m = 0;
  std::int32_t azimuth = 0;  // counter-clockwise, below kTurn
};
/// Converts the first `count` points to sightings.
void SightAll(const std::vector<Point>& points, std::size_t count,
              std::vector<Sighting>* sightings);

/// Returns std::atan2(y, x), in a quarter of its time.
double AngleOf(double y, double x);

/// The beams and columns of a sensor. The points of a beam lie on a line in the plane of `rho` and
/// z. There is one point in each column of a turn, at the azimuth of the column.
///
/// If a beam passes the origin at a distance, an angle is added to the azimuths of its points: see
/// SideAngle(). The points of bending beams are only near the line.
struct BeamTable {
  static constexpr std::uint32_t kMostPeriod = 4;
  struct Beam {
    std::int32_t elevation = 0;
    std::int32_t offset = 0;     // azimuth of column 0
    std::int32_t height_um = 0;  // height of the line above the origin
    std::int32_t side_um = 0;    // distance at which the beam passes left of the origin
    std::array<std::int32_t, kMostPeriod>
        swings{};               // added to azimuths; index: firing modulo `period`
    std::int32_t reach_um = 0;  // position of range 0 along the beam
    std::uint32_t delay = 0;    // delay of the beam in columns; below columns()

    bool Swings() const { return swings != decltype(swings){}; }
  };
  static constexpr std::uint32_t kParts = 256;
  static constexpr std::uint32_t kMostBeams = 1'024;
  static constexpr std::uint32_t kMostColumns = 16'384;
  static constexpr std::int32_t kMostOffsetUm = 1'000'000;
  static constexpr std::int32_t kLengthUnitUm = 50;  // unit of heights, sides and reaches
  static constexpr std::uint32_t kMostGrains = 1U << 18;
  /// The unit of swings: 0.0014 degrees.
  static constexpr std::int32_t kSwingUnit = 16;
  /// The units of elevations and offsets if beams bend. They may be coarse, because the residuals
  /// of points make up for them.
  static constexpr std::int32_t kBentElevation = 128;
  static constexpr std::int32_t kBentOffset = 32;

  std::uint32_t turn = 0;             // columns of a turn, in 1/kParts
  std::uint32_t period = 1;           // of the swings; 1: no swings
  std::vector<Beam> beams;            // top to bottom
  std::uint32_t grains = 0;           // grains in a turn; 0: the columns have equal steps
  std::vector<std::uint32_t> places;  // places of the columns, in grains, ascending
  bool bends = false;                 // each point has its own elevation
  bool beams_follow = true;  // CodeBeams() codes the beams; false: they are in the table (old)
  // Only a table with a path uses these fields.
  std::int32_t rate = 0;       // of the turn, for BeamPath; 0: no path
  std::vector<PathBeam> path;  // one for each beam

  std::uint32_t columns() const { return (turn + kParts - 1) / kParts; }
  std::uint32_t rows() const { return static_cast<std::uint32_t>(beams.size()); }
  bool has_offsets() const;
  bool has_path() const { return rate != 0; }
  /// Returns the step from one column to the next, in angle units.
  std::int32_t step() const {
    return has_path() ? std::abs(rate) >> BeamPath::kRateBits
                      : static_cast<std::int32_t>(std::uint64_t{kTurn} * kParts / turn);
  }
  /// Returns the index of the firing in which a beam measures a column.
  std::uint32_t FiringOf(std::uint32_t beam, std::uint32_t column) const {
    column += beams[beam].delay;
    return column >= columns() ? column - columns() : column;
  }
  /// Returns the column that a beam measures in a firing.
  std::uint32_t ColumnOf(const Beam& beam, std::uint32_t firing) const {
    return firing >= beam.delay ? firing - beam.delay : firing + columns() - beam.delay;
  }
  /// Returns the azimuth of a pixel, not wrapped. Must not be called for a table with a path.
  std::int32_t AzimuthOf(std::uint32_t beam, std::uint32_t column) const {
    column = FiringOf(beam, column);
    const std::uint64_t angle = places.empty() ? std::uint64_t{column} * kParts * kTurn / turn
                                               : std::uint64_t{places[column]} * kTurn / grains;
    std::int32_t azimuth = beams[beam].offset + static_cast<std::int32_t>(angle);
    if (period > 1) azimuth += beams[beam].swings[column % period];
    return azimuth;
  }
  /// The cosine and the sine of an angle, which is in angle units.
  struct Slope {
    explicit Slope(double angle);
    double cosine;
    double sine;
  };
  Point At(std::uint32_t beam, std::int32_t azimuth, const Slope& slope,
           std::uint32_t range_mm) const;

  /// Writes everything except the beams, the places and the curves.
  void Write(ByteWriter* writer) const;
  /// Reads what Write() wrote. Returns nothing if a number is one that no encoder writes. The parts
  /// that come later in the stream are set to 0: the beams, the places (if there are grains) and
  /// the curves (on a path).
  static std::optional<BeamTable> Read(ByteReader* reader);
};

/// Returns the angle that is added to the azimuth of a point because its beam passes the origin at
/// a distance.
inline double SideAngle(const BeamTable::Beam& beam, double rho_m) {
  constexpr double kUnits = 1e-6 / kRadians;
  return beam.side_um == 0 ? 0 : kUnits * beam.side_um / std::max(rho_m, 1e-3);
}

/// Wraps an angle to the range from -kTurn / 2 to kTurn / 2.
inline std::int32_t Wrapped(std::int32_t angle) {
  return ((angle + kTurn / 2) & (kTurn - 1)) - kTurn / 2;
}

/// Rounds like std::lround(), without a call or a jump.
inline std::int32_t ToNearest(double value) {
  return static_cast<std::int32_t>(value + std::copysign(0.5, value));
}

/// Computes the azimuths of a table's pixels without a division for each of them.
class ColumnAngles {
 public:
  explicit ColumnAngles(const BeamTable& table);
  /// Returns BeamTable::AzimuthOf() minus the offset of the beam.
  std::int32_t Of(std::uint32_t beam, std::uint32_t column) const {
    const std::uint32_t firing = table_.FiringOf(beam, column);
    if (table_.period == 1) return angles_[firing];
    return angles_[firing] + table_.beams[beam].swings[firing % table_.period];
  }
  /// Returns the angles of the firings, without swings.
  const std::vector<std::int32_t>& firings() const { return angles_; }

 private:
  const BeamTable& table_;
  std::vector<std::int32_t> angles_;
};

/// Finds the column of an azimuth.
class ColumnFinder {
 public:
  /// A column, and the distance of an azimuth from this column.
  struct Found {
    std::uint32_t column = 0;
    std::int32_t residual = 0;
  };
  explicit ColumnFinder(const BeamTable& table);
  /// Returns the column with the nearest azimuth. `azimuth` is an azimuth minus the offset of the
  /// beam.
  Found Find(std::uint32_t beam, std::int32_t azimuth) const;

 private:
  Found NearestOf(const BeamTable::Beam& beam, std::uint32_t first, std::int32_t away) const;

  static constexpr unsigned kShift = kTurnBits - 14;  // from an angle to its bucket
  const BeamTable& table_;
  ColumnAngles angles_;
  std::vector<std::int32_t> around_;    // angles of the last firing, all firings, the first two
  std::vector<std::uint16_t> buckets_;  // first firing at or after each bucket; empty: equal steps
  std::vector<bool> swings_;            // whether each beam has swings
};

}  // namespace lidar::codec::cloud
