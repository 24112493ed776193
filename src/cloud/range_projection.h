// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts a range image to xyz and back, with the formulas of the Ouster SDK (xyzlut).
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/cloud/sensor_model.h"

namespace lidar {

struct ColumnWindow {
  std::uint32_t first = 0;  // measurement id of the first column; the window may wrap around
  std::uint32_t count = 0;
};

/// Converts ranges to points: p = (r - |beam_to_lidar|) direction(beam, column) + offset(column).
/// It is immutable, so several threads may use the same object.
class RangeProjection {
 public:
  explicit RangeProjection(const SensorModel& model);

  /// Returns x, y and z [m] of a return at `range_mm`, or zeros if the range is 0.
  std::array<float, 3> Point(std::uint32_t beam, std::uint32_t column,
                             std::uint32_t range_mm) const;
  /// Returns the unit vector along which the point moves if its range grows.
  std::array<float, 3> Direction(std::uint32_t beam, std::uint32_t column) const;
  /// Returns the range [mm, not rounded] whose point is nearest to `xyz` [m].
  double RangeOf(std::uint32_t beam, std::uint32_t column, const float* xyz) const;
  /// Projects the ranges [mm, below 2^31] of all beams. Writes x, y and z of `ranges[beam *
  /// window.count + i]` as F32 to `xyz + point_step * (beam * window.count + i)`.
  void Project(const std::uint32_t* ranges, ColumnWindow window, std::uint8_t* xyz,
               std::size_t point_step) const;
  /// Projects one beam. `behind` is null, or has four bytes for each point, which are written after
  /// z. With `behind`, points of 16 bytes are written in a single step.
  void ProjectBeam(std::uint32_t beam, const std::uint32_t* ranges, ColumnWindow window,
                   const std::uint32_t* behind, std::uint8_t* xyz, std::size_t point_step) const;

  std::uint32_t beams() const { return static_cast<std::uint32_t>(beams_.size()); }
  std::uint32_t columns() const { return static_cast<std::uint32_t>(columns_.size()); }

 private:
  using Vector = std::array<float, 3>;
  struct Column {
    std::array<float, 9> rotation;  // rotation by the encoder, then by lidar_to_sensor
    Vector offset;                  // position of the beams' origin [m]
  };

  struct Run;
  template <bool kBehind>
  void ProjectRun(const Run& run, const std::uint32_t* behind) const;

  std::vector<Vector> beams_;  // directions at encoder angle 0
  std::vector<Column> columns_;
  /// The columns transposed: first the nine numbers of the rotation, then the three of the offset.
  /// Therefore the numbers of neighbouring columns are adjacent and can be computed at once.
  std::array<std::vector<float>, 12> numbers_;
  float beam_origin_m_ = 0;  // length of the vector beam_to_lidar [m]
};

}  // namespace lidar
