// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/synth/geometry.h"

namespace lidar::synth {

Rotation Pose::ToRotation() const {
  const double cy = std::cos(yaw);
  const double sy = std::sin(yaw);
  const double cp = std::cos(pitch);
  const double sp = std::sin(pitch);
  const double cr = std::cos(roll);
  const double sr = std::sin(roll);
  const std::array<double, 9> m = {cy * cp,
                                   cy * sp * sr - sy * cr,
                                   cy * sp * cr + sy * sr,
                                   sy * cp,
                                   sy * sp * sr + cy * cr,
                                   sy * sp * cr - cy * sr,
                                   -sp,
                                   cp * sr,
                                   cp * cr};
  Rotation rotation;
  for (std::size_t i = 0; i < m.size(); ++i) rotation.m[i] = static_cast<float>(m[i]);
  return rotation;
}

std::array<double, 4> Pose::ToQuaternion() const {
  const double cy = std::cos(yaw / 2);
  const double sy = std::sin(yaw / 2);
  const double cp = std::cos(pitch / 2);
  const double sp = std::sin(pitch / 2);
  const double cr = std::cos(roll / 2);
  const double sr = std::sin(roll / 2);
  return {cy * cp * sr - sy * sp * cr, cy * sp * cr + sy * cp * sr, sy * cp * cr - cy * sp * sr,
          cy * cp * cr + sy * sp * sr};
}

}  // namespace lidar::synth
