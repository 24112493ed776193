// SPDX-License-Identifier: LGPL-2.1-or-later
// The geometry of the beams of a spinning sensor. It has everything that is needed to convert
// ranges to xyz.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"

namespace lidar {

struct Beam {
  double azimuth_deg = 0;   // as Ouster's beam_azimuth_angles: clockwise from the encoder's angle
  double altitude_deg = 0;  // above the horizon
  int pixel_shift = 0;      // destaggered column = (column + pixel_shift) mod columns_per_scan
};

/// A 4 x 4 matrix, row-major. The translation is in metres.
using Transform = std::array<double, 16>;
constexpr Transform kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

struct SensorModel {
  std::uint32_t columns_per_scan = 0;  // columns of a full turn, even with an azimuth window
  std::uint32_t range_unit_mm = 1;     // resolution of the ranges; 8 for RNG15 profiles
  double beam_to_lidar_x_m = 0;        // position of the beams' origin in the lidar frame
  double beam_to_lidar_z_m = 0;
  Transform lidar_to_sensor = kIdentity;
  std::vector<Beam> beams;  // from top to bottom

  /// Returns the caps field `sensor-model` (docs/wire-format.md). It is little-endian and has a
  /// version number.
  std::vector<std::uint8_t> Serialise() const;
  /// Returns nothing if the version is newer, if the length is wrong, if there are more than
  /// kMaxBeams beams or kMaxColumns columns, or if a number is not finite or implausibly large.
  static std::optional<SensorModel> Parse(ByteView bytes);

  static constexpr std::uint32_t kMaxBeams = 1024;
  static constexpr std::uint32_t kMaxColumns = 16384;
};

}  // namespace lidar
