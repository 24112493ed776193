// SPDX-License-Identifier: LGPL-2.1-or-later
// The shapes of the synthetic world, and the intersections of rays with them.
#pragma once
#include <cstdint>

#include "src/synth/geometry.h"
#include "src/synth/random.h"

namespace lidar::synth {

enum class ShapeKind : std::uint8_t {
  kBox,        // rotated about z
  kCabin,      // a box whose front and back lean: the windows of a car
  kColumn,     // vertical cylinder
  kBar,        // cylinder along the x axis of the shape
  kEllipsoid,  // solid
  kFoliage     // ellipsoid that lets some light through
};

enum class Surface : std::uint8_t { kPlain, kFacade, kGlass, kRetroreflector };

/// A body in the world. Its coordinates are relative to the anchor of the view for which it was
/// made.
struct Shape {
  ShapeKind kind = ShapeKind::kBox;
  Surface surface = Surface::kPlain;
  float reflectivity = 0.3F;  // 1 is a white wall; a retroreflector is brighter
  Vec3 center;
  Vec3 half;  // half extents; a column's radius is half.x, a bar's half.y
  float cos_yaw = 1;
  float sin_yaw = 0;
  Vec3 velocity;  // [m/s]
};

struct Hit {
  float distance = 0;      // along the ray [m]
  float reflectivity = 0;  // at the point of the hit, including the texture
  float cosine = 1;        // cosine of the angle of incidence
};

/// Returns true if the ray meets the shape nearer than hit->distance, and then updates `hit`.
/// `noise` belongs to this ray, and decides where the ray meets a leaf.
bool Intersect(const Shape& shape, const Ray& ray, Random* noise, Hit* hit);

}  // namespace lidar::synth
