// SPDX-License-Identifier: LGPL-2.1-or-later
// The objects of the synthetic world, and intersections of rays with them.
#pragma once
#include <cstdint>

#include "src/synth/geometry.h"
#include "src/synth/random.h"

namespace lidar::synth {

enum class ShapeKind : std::uint8_t {
  kBox,        // turned about z
  kCabin,      // a box with leaning front and back: the windows of a car
  kColumn,     // vertical cylinder
  kBar,        // cylinder along the x axis of the shape
  kEllipsoid,  // solid
  kFoliage     // ellipsoid that lets some light through
};

enum class Surface : std::uint8_t { kPlain, kFacade, kGlass, kRetroreflector };

/// A primitive. Coordinates are relative to the anchor of the view it was made for.
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
  float reflectivity = 0;  // at the point, texture included
  float cosine = 1;        // of the angle of incidence
};

/// Returns true if the ray meets the shape nearer than hit->distance, which it then updates.
/// `noise` belongs to this ray: it decides whether the ray meets a leaf.
bool Intersect(const Shape& shape, const Ray& ray, Random* noise, Hit* hit);

}  // namespace lidar::synth
