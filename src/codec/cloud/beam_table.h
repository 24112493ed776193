// SPDX-License-Identifier: LGPL-2.1-or-later
// Where the beams of a spinning sensor look, found in the points of its clouds.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/base/byte_writer.h"
#include "src/codec/cloud/cell_cover.h"

namespace lidar::codec::cloud {

/// Angles are in 2^-22 turns: half of one moves a point at 200 m by 0.15 mm.
constexpr unsigned kTurnBits = 22;
constexpr std::int32_t kTurn = 1 << kTurnBits;
constexpr double kRadians = 2 * M_PI / kTurn;

/// A point as the sensor at the origin sees it.
struct Sighting {
  explicit Sighting(const Point& point);
  double range_m;
  double rho_m;          // of it, along the ground
  double elevation;      // in units
  std::int32_t azimuth;  // counter-clockwise, below kTurn
};

struct BeamTable {
  struct Beam {
    std::int32_t elevation = 0;
    std::int32_t offset = 0;  // azimuth of column 0
  };
  static constexpr std::uint32_t kParts = 256;
  static constexpr std::uint32_t kMostBeams = 1'024;
  static constexpr std::uint32_t kMostColumns = 16'384;

  std::uint32_t turn = 0;   // columns of a turn, in 1/kParts
  std::vector<Beam> beams;  // top to bottom

  std::uint32_t columns() const { return (turn + kParts - 1) / kParts; }
  std::uint32_t rows() const { return static_cast<std::uint32_t>(beams.size()); }
  /// Azimuths are not wrapped.
  std::int32_t AzimuthOf(std::uint32_t beam, std::uint32_t column) const {
    const std::uint64_t angle = std::uint64_t{column} * kParts * kTurn / turn;
    return beams[beam].offset + static_cast<std::int32_t>(angle);
  }
  /// The column whose azimuth is nearest.
  std::uint32_t ColumnOf(std::uint32_t beam, std::int32_t azimuth) const;
  /// The beam whose elevation is nearest.
  std::uint32_t BeamOf(double elevation) const;
  Point At(std::uint32_t beam, std::int32_t azimuth, std::uint32_t range_mm) const;

  void Write(ByteWriter* writer) const;
  /// Returns nothing for numbers that no encoder writes.
  static std::optional<BeamTable> Read(ByteReader* reader);
};

/// From -kTurn / 2 to kTurn / 2.
inline std::int32_t Wrapped(std::int32_t angle) {
  return ((angle + kTurn / 2) & (kTurn - 1)) - kTurn / 2;
}

/// Returns nothing where most points lie on no beam.
std::optional<BeamTable> FindBeams(const std::vector<Sighting>& points);

}  // namespace lidar::codec::cloud
