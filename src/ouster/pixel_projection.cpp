// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/ouster/pixel_projection.h"

#include <cmath>

namespace lidar::ouster {
namespace {

constexpr double kRadiansPerDegree = 3.14159265358979323846 / 180;

std::array<float, 3> Rotate(const Transform& t, const std::array<double, 3>& v) {
  std::array<float, 3> out{};
  for (std::size_t row = 0; row < 3; ++row)
    out[row] =
        static_cast<float>(t[row * 4] * v[0] + t[row * 4 + 1] * v[1] + t[row * 4 + 2] * v[2]);
  return out;
}

}  // namespace

PixelProjection::PixelProjection(const Metadata& metadata)
    : columns_(metadata.model.columns_per_scan) {
  if (metadata.pixel_angles.empty()) {
    spinning_.emplace(metadata.model);
    return;
  }
  const SensorModel& model = metadata.model;
  const PixelAngles& angles = metadata.pixel_angles;
  const Transform& t = model.lidar_to_sensor;
  directions_.reserve(angles.azimuth_deg.size());
  for (std::size_t i = 0; i < angles.azimuth_deg.size(); ++i) {
    const double azimuth = static_cast<double>(angles.azimuth_deg[i]) * kRadiansPerDegree;
    const double altitude = static_cast<double>(angles.altitude_deg[i]) * kRadiansPerDegree;
    directions_.push_back(Rotate(t, {std::cos(azimuth) * std::cos(altitude),
                                     std::sin(azimuth) * std::cos(altitude), std::sin(altitude)}));
  }
  offset_ = Rotate(t, {model.beam_to_lidar_x_m, 0, model.beam_to_lidar_z_m});
  for (std::size_t row = 0; row < 3; ++row) offset_[row] += static_cast<float>(t[row * 4 + 3]);
  beam_origin_m_ = static_cast<float>(std::hypot(model.beam_to_lidar_x_m, model.beam_to_lidar_z_m));
}

std::array<float, 3> PixelProjection::Direction(std::uint32_t beam, std::uint32_t column) const {
  return spinning_ ? spinning_->Direction(beam, column)
                   : directions_[std::size_t{beam} * columns_ + column];
}

}  // namespace lidar::ouster
