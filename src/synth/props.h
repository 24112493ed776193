// SPDX-License-Identifier: LGPL-2.1-or-later
// Makes things that several scenes contain: cars, people, trees, poles.
#pragma once
#include <vector>

#include "src/synth/shapes.h"

namespace lidar::synth {

struct Placement {
  float x = 0;
  float y = 0;
  float z = 0;        // height of the ground
  float yaw = 0;      // [rad]
  float speed_x = 0;  // speed along the world's x [m/s]
};

/// Adds a car, or in some cases a van. `random` decides which of them, and what it looks like.
void AddCar(const Placement& at, Random random, std::vector<Shape>* out);
void AddPedestrian(const Placement& at, Random random, std::vector<Shape>* out);
void AddTree(const Placement& at, Random random, std::vector<Shape>* out);
/// Adds a lamp on a pole. `arm` is the length of its arm along y [m], and the sign of `arm` gives
/// the side.
void AddLamp(const Placement& at, float arm, std::vector<Shape>* out);
/// Adds a retroreflecting plate on a post. The plate faces traffic that drives along x.
void AddSign(const Placement& at, std::vector<Shape>* out);

Shape MakeBox(Vec3 center, Vec3 half, float reflectivity);

}  // namespace lidar::synth
