// SPDX-License-Identifier: LGPL-2.1-or-later
#include "cloud/range_projection.h"

#include <cmath>
#include <cstring>

namespace lidar {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr float kMetresPerMm = 1e-3F;

double Radians(double degrees) { return degrees * kPi / 180.0; }

std::array<float, 3> Apply(const std::array<float, 9>& m, const std::array<float, 3>& v) {
  return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
          m[6] * v[0] + m[7] * v[1] + m[8] * v[2]};
}

}  // namespace

RangeProjection::RangeProjection(const SensorModel& model) {
  beam_origin_m_ =
      static_cast<float>(model.beam_to_lidar_z_m == 0.0
                             ? model.beam_to_lidar_x_m
                             : std::hypot(model.beam_to_lidar_x_m, model.beam_to_lidar_z_m));
  for (const Beam& b : model.beams) {
    const double azimuth = -Radians(b.azimuth_deg);
    const double altitude = Radians(b.altitude_deg);
    beams_.push_back({static_cast<float>(std::cos(azimuth) * std::cos(altitude)),
                      static_cast<float>(std::sin(azimuth) * std::cos(altitude)),
                      static_cast<float>(std::sin(altitude))});
  }
  const Transform& t = model.lidar_to_sensor;
  columns_.resize(model.columns_per_scan);
  for (std::uint32_t m = 0; m < model.columns_per_scan; ++m) {
    const double encoder = 2 * kPi - 2 * kPi * m / model.columns_per_scan;
    const double c = std::cos(encoder);
    const double s = std::sin(encoder);
    Column& column = columns_[m];
    for (std::size_t row = 0; row < 3; ++row) {
      const double* in = &t[row * 4];
      column.rotation[row * 3] = static_cast<float>(in[0] * c + in[1] * s);
      column.rotation[row * 3 + 1] = static_cast<float>(in[1] * c - in[0] * s);
      column.rotation[row * 3 + 2] = static_cast<float>(in[2]);
      column.offset[row] = static_cast<float>(model.beam_to_lidar_x_m * (in[0] * c + in[1] * s) +
                                              model.beam_to_lidar_z_m * in[2] + in[3]);
    }
  }
}

std::array<float, 3> RangeProjection::Direction(std::uint32_t beam, std::uint32_t column) const {
  return Apply(columns_[column].rotation, beams_[beam]);
}

std::array<float, 3> RangeProjection::Point(std::uint32_t beam, std::uint32_t column,
                                            std::uint32_t range_mm) const {
  if (range_mm == 0) return {0, 0, 0};
  const Vector d = Direction(beam, column);
  const Vector& o = columns_[column].offset;
  const float r = static_cast<float>(range_mm) * kMetresPerMm - beam_origin_m_;
  return {r * d[0] + o[0], r * d[1] + o[1], r * d[2] + o[2]};
}

double RangeProjection::RangeOf(std::uint32_t beam, std::uint32_t column, const float* xyz) const {
  const Vector d = Direction(beam, column);
  const Vector& o = columns_[column].offset;
  const float along = (xyz[0] - o[0]) * d[0] + (xyz[1] - o[1]) * d[1] + (xyz[2] - o[2]) * d[2];
  return 1e3 * static_cast<double>(along + beam_origin_m_);
}

void RangeProjection::Project(const std::uint32_t* ranges, ColumnWindow window, std::uint8_t* xyz,
                              std::size_t point_step) const {
  for (std::uint32_t beam = 0; beam < beams(); ++beam) {
    std::uint32_t column = window.first % columns();
    for (std::uint32_t i = 0; i < window.count; ++i) {
      const Vector p = Point(beam, column, *ranges++);
      std::memcpy(xyz, p.data(), sizeof p);
      xyz += point_step;
      if (++column == columns()) column = 0;
    }
  }
}

}  // namespace lidar
