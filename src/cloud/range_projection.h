// SPDX-License-Identifier: LGPL-2.1-or-later
// Range image to xyz and back, with the formulas of the Ouster SDK (xyzlut).
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/cloud/sensor_model.h"

namespace lidar {

struct ColumnWindow {
  std::uint32_t first = 0;  // measurement id of the first column; the window may wrap
  std::uint32_t count = 0;
};

/// Turns ranges into points: p = (r - |beam_to_lidar|) direction(beam, column) + offset(column).
/// Immutable, so threads may share one.
class RangeProjection {
 public:
  explicit RangeProjection(const SensorModel& model);

  /// x, y, z [m] of one return at `range_mm`; zeros for range 0.
  std::array<float, 3> Point(std::uint32_t beam, std::uint32_t column,
                             std::uint32_t range_mm) const;
  /// Unit vector along which a range moves its point.
  std::array<float, 3> Direction(std::uint32_t beam, std::uint32_t column) const;
  /// Range [mm, not rounded] whose point is nearest to `xyz` [m].
  double RangeOf(std::uint32_t beam, std::uint32_t column, const float* xyz) const;
  /// Projects the ranges [mm, below 2^31] of all beams: writes x, y and z of `ranges[beam *
  /// window.count + i]` as F32 to `xyz + point_step * (beam * window.count + i)`.
  void Project(const std::uint32_t* ranges, ColumnWindow window, std::uint8_t* xyz,
               std::size_t point_step) const;
  /// Projects one beam. If `behind` is not null it has the four bytes to write after z in each
  /// point, so that points of 16 bytes are written at once.
  void ProjectBeam(std::uint32_t beam, const std::uint32_t* ranges, ColumnWindow window,
                   const std::uint32_t* behind, std::uint8_t* xyz, std::size_t point_step) const;

  std::uint32_t beams() const { return static_cast<std::uint32_t>(beams_.size()); }
  std::uint32_t columns() const { return static_cast<std::uint32_t>(columns_.size()); }

 private:
  using Vector = std::array<float, 3>;
  struct Column {
    std::array<float, 9> rotation;  // by the encoder, then by lidar_to_sensor
    Vector offset;                  // of the beams' origin, in metres
  };

  struct Run;
  template <bool kBehind>
  void ProjectRun(const Run& run, const std::uint32_t* behind) const;

  std::vector<Vector> beams_;  // directions at encoder angle 0
  std::vector<Column> columns_;
  /// columns_ transposed (the rotation's nine numbers, then the offset's three), so that
  /// neighbouring columns are computed at once.
  std::array<std::vector<float>, 12> numbers_;
  float beam_origin_m_ = 0;  // |beam_to_lidar|
};

}  // namespace lidar
