// SPDX-License-Identifier: LGPL-2.1-or-later
// Things that several scenes place: cars, people, trees, poles.
#pragma once
#include <vector>

#include "src/synth/shapes.h"

namespace lidar::synth {

struct Placement {
  float x = 0;
  float y = 0;
  float z = 0;        // of the ground
  float yaw = 0;      // [rad]
  float speed_x = 0;  // [m/s] along the world's x
};

/// A car, a van now and then; its make comes from `random`.
void AddCar(const Placement& at, Random random, std::vector<Shape>* out);
void AddPedestrian(const Placement& at, Random random, std::vector<Shape>* out);
void AddTree(const Placement& at, Random random, std::vector<Shape>* out);
/// A lamp whose arm, `arm` metres long, reaches along y (its sign is the side).
void AddLamp(const Placement& at, float arm, std::vector<Shape>* out);
/// A retroreflecting plate on a post. It faces traffic along x.
void AddSign(const Placement& at, std::vector<Shape>* out);

Shape MakeBox(Vec3 center, Vec3 half, float reflectivity);

}  // namespace lidar::synth
