// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/synth/terrain.h"

namespace lidar::synth {

Terrain::Point Terrain::ToPlan(Point world) {
  return {world.a - kBendU.At(world.b), world.b - kBendV.At(world.a)};
}

Terrain::Point Terrain::FromPlan(Point plan) {
  // Each round leaves less than a tenth of the error, so that an error of 20 um is left in the end.
  constexpr int kRounds = 6;
  Point world = plan;
  for (int i = 0; i < kRounds; ++i) {
    world.a = plan.a + kBendU.At(world.b);
    world.b = plan.b + kBendV.At(world.a);
  }
  return world;
}

Terrain::Point Terrain::DirectionAt(Point world, bool along_u) {
  return along_u ? Point{1, kBendV.SlopeAt(world.a)} : Point{kBendU.SlopeAt(world.b), 1};
}

Terrain::Ground Terrain::At(Point world) {
  return {kHillX.At(world.a) + kHillY.At(world.b), kHillX.SlopeAt(world.a),
          kHillY.SlopeAt(world.b)};
}

}  // namespace lidar::synth
