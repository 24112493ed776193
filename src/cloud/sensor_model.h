// SPDX-License-Identifier: LGPL-2.1-or-later
// The geometry of a spinning sensor's beams: all that is needed to turn ranges into xyz.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"

namespace lidar {

struct Beam {
  double azimuth_deg = 0;   // Ouster's beam_azimuth_angles: clockwise from the encoder's angle
  double altitude_deg = 0;  // above the horizon
  int pixel_shift = 0;      // destaggered column = (column + pixel_shift) mod columns_per_scan
};

/// Row-major 4 x 4; translation in metres.
using Transform = std::array<double, 16>;
constexpr Transform kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

struct SensorModel {
  std::uint32_t columns_per_scan = 0;  // of a full turn, for any azimuth window
  std::uint32_t range_unit_mm = 1;     // resolution of the ranges: 8 for RNG15 profiles
  double beam_to_lidar_x_m = 0;        // origin of the beams relative to the lidar frame
  double beam_to_lidar_z_m = 0;
  Transform lidar_to_sensor = kIdentity;
  std::vector<Beam> beams;  // top to bottom

  /// The caps field `sensor-model` (docs/wire-format.md): little-endian, versioned.
  std::vector<std::uint8_t> Serialise() const;
  /// Returns nothing for a newer version, a wrong length, more than kMaxBeams or kMaxColumns, or
  /// numbers that are not finite or implausibly large.
  static std::optional<SensorModel> Parse(ByteView bytes);

  static constexpr std::uint32_t kMaxBeams = 1024;
  static constexpr std::uint32_t kMaxColumns = 16384;
};

}  // namespace lidar
