// SPDX-License-Identifier: LGPL-2.1-or-later
// Vectors, rays and poses of the synthetic world: x forward along the road, y left, z up, metres.
#pragma once
#include <array>
#include <cmath>

namespace lidar::synth {

struct Vec3 {
  float x = 0;
  float y = 0;
  float z = 0;
};
constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vec3 operator*(float f, Vec3 a) { return {f * a.x, f * a.y, f * a.z}; }
constexpr float Dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// A rotation matrix, row by row.
struct Rotation {
  std::array<float, 9> m{};
  Vec3 operator*(Vec3 v) const {
    return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
            m[6] * v.x + m[7] * v.y + m[8] * v.z};
  }
};

/// A ray with a unit direction, and values that each intersection test needs.
struct Ray {
  Vec3 origin;
  Vec3 direction;
  Vec3 inverse;          // inverse of the direction, for each axis
  float horizontal = 0;  // length of the direction's projection onto the ground
  float slope = 0;       // rise of the direction divided by this length
};

inline Ray MakeRay(Vec3 origin, Vec3 direction) {
  // A direction that is exactly parallel to a face has no inverse, so a large number is used.
  const auto inverse = [](float v) { return 1.0F / (std::abs(v) > 1e-9F ? v : 1e-9F); };
  const float horizontal = std::sqrt(direction.x * direction.x + direction.y * direction.y) + 1e-9F;
  return {origin,
          direction,
          {inverse(direction.x), inverse(direction.y), inverse(direction.z)},
          horizontal,
          direction.z / horizontal};
}

/// The position [m] and the orientation [rad] of the sensor in the world. The sensor is rotated by
/// yaw first, then by pitch, and then by roll. If pitch is positive, the nose is down.
struct Pose {
  double x = 0;
  double y = 0;
  double z = 0;
  double yaw = 0;
  double pitch = 0;
  double roll = 0;

  Rotation ToRotation() const;
  /// Returns x, y, z and w.
  std::array<double, 4> ToQuaternion() const;
};

}  // namespace lidar::synth
