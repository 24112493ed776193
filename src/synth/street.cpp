// SPDX-License-Identifier: LGPL-2.1-or-later
// A street in a town: façades, pavements, parked and moving cars, trees, lamps, people, crossings.
#include "src/synth/street.h"

#include <algorithm>

#include "src/synth/props.h"
#include "src/synth/scene_makers.h"

namespace lidar::synth {
namespace {

constexpr float kHalfRoad = kStreetHalfRoad;
constexpr float kKerb = kStreetKerb;
constexpr float kLane = kStreetLane;
constexpr float kParked = 4.65F;  // middle of a parked car
constexpr double kOncomingSpeed = 11;
constexpr double kOncomingGap = 46;

enum Kind : std::uint64_t {
  kHouse = 1,
  kParkedLeft,
  kParkedRight,
  kTree,
  kLamp,
  kWalker,
  kTraffic
};

bool IsCrossing(double x) {
  const auto block = static_cast<std::int64_t>(std::floor(x / kBlock));
  return ((block % kBlocksToCrossing) + kBlocksToCrossing) % kBlocksToCrossing == 3;
}

}  // namespace

TrajectorySettings Street::Lane(double speed_mps) const {
  TrajectorySettings lane;
  lane.speed_mps = speed_mps;
  lane.lane_y_m = -static_cast<double>(kLane);
  return lane;
}

void Street::AddStatic(const View& view, std::vector<Shape>* shapes) const {
  for (const float side : {-1.0F, 1.0F}) {
    AddHouses(view, side, shapes);
    AddParked(view, side, shapes);
    AddFurniture(view, side, shapes);
  }
}

void Street::AddMoving(const View& view, const Instant& now, std::vector<Shape>* shapes) const {
  AddOwnLane(view, now, shapes);
  AddOncoming(view, now, shapes);
  AddWalkers(view, now, shapes);
}

void Street::AddHouses(const View& view, float side, std::vector<Shape>* shapes) const {
  const std::uint64_t kind = kHouse + (side > 0 ? 64 : 0);
  ForEachCell(view, kBlock, kind, [&](Random random, std::int64_t index, float x) {
    if (IsCrossing((static_cast<double>(index) + 0.5) * kBlock)) return;
    if (random.Chance(0.1F)) return;  // a yard
    const float setback = random.Chance(0.25F) ? random.Uniform(0.5F, 3.0F) : 0.0F;
    const float half_height = random.Uniform(3.2F, 9.6F);
    const float half_depth = random.Uniform(5.0F, 7.0F);
    const float half_width = random.Chance(0.2F) ? random.Uniform(6.5F, 8.5F) : 9.0F;
    Shape house = MakeBox({x, side * (kPavementEnd + setback + half_depth), half_height},
                          {half_width, half_depth, half_height}, random.Uniform(0.2F, 0.7F));
    house.surface = Surface::kFacade;
    shapes->push_back(house);
    if (random.Chance(0.3F)) {  // a balcony, or a shop's awning
      shapes->push_back(
          MakeBox({x + random.Uniform(-4.0F, 4.0F), side * (kPavementEnd + setback - 0.5F), 3.3F},
                  {1.6F, 0.5F, 0.08F}, 0.5F));
    }
  });
}

void Street::AddParked(const View& view, float side, std::vector<Shape>* shapes) const {
  ForEachCell(view, 6.2, side > 0 ? kParkedLeft : kParkedRight,
              [&](Random random, std::int64_t index, float x) {
                const double middle = (static_cast<double>(index) + 0.5) * 6.2;
                if (IsCrossing(middle - 5) || IsCrossing(middle + 5) || random.Chance(0.3F)) return;
                Placement at;
                at.x = x + random.Uniform(-0.3F, 0.3F);
                at.y = side * kParked + random.Uniform(-0.12F, 0.12F);
                at.yaw = random.Uniform(-0.03F, 0.03F) + (side > 0 ? 3.14159265F : 0.0F);
                AddCar(at, random, shapes);
              });
}

void Street::AddFurniture(const View& view, float side, std::vector<Shape>* shapes) const {
  const std::uint64_t offset = side > 0 ? 64 : 0;
  ForEachCell(view, 12, kTree + offset, [&](Random random, std::int64_t index, float x) {
    if (IsCrossing((static_cast<double>(index) + 0.5) * 12) || random.Chance(0.45F)) return;
    AddTree({x + 3, side * 6.9F, kKerb, 0, 0}, random, shapes);
  });
  ForEachCell(view, 27, kLamp + offset, [&](Random random, std::int64_t, float x) {
    // Lamps alternate between both sides of the street.
    const float shifted = side > 0 ? x : x + 13.5F;
    AddLamp({shifted, side * 6.3F, kKerb, 0, 0}, -side * 2.2F, shapes);
    if (random.Chance(0.35F)) AddSign({shifted - 6, side * 6.2F, kKerb, 0, 0}, shapes);
    if (random.Chance(0.3F))
      shapes->push_back(
          MakeBox({shifted + 4, side * 8.7F, kKerb + 0.55F}, {0.5F, 0.35F, 0.55F}, 0.3F));
  });
}

void Street::AddOwnLane(const View& view, const Instant& now, std::vector<Shape>* shapes) const {
  // Two cars drive ahead of the sensor's car and one behind it, at varying distances.
  struct Follower {
    double gap, breath, period_s;
  };
  for (const Follower& f : {Follower{24, 6, 19}, Follower{-17, 3, 13}, Follower{61, 9, 29}}) {
    const double turn = 6.283185307179586 / f.period_s;
    const bool stands = now.ego_speed == 0;
    Placement at;
    at.x = static_cast<float>(now.ego_x - view.anchor_x + f.gap +
                              (stands ? 0 : f.breath * std::sin(turn * now.time_s)));
    at.y = -kLane;
    at.speed_x = static_cast<float>(
        stands ? 0 : now.ego_speed + f.breath * turn * std::cos(turn * now.time_s));
    if (std::abs(at.x) < view.radius)
      AddCar(at, Random(seed(), kTraffic, static_cast<std::int64_t>(f.gap)), shapes);
  }
}

void Street::AddOncoming(const View& view, const Instant& now, std::vector<Shape>* shapes) const {
  // The oncoming cars drive as one column. The view moves with the column, so that the cells of the
  // view stay with the cars.
  View column = view;
  const double shift = kOncomingSpeed * now.time_s;
  column.anchor_x = view.anchor_x + shift;
  ForEachCell(column, kOncomingGap, kTraffic + 64, [&](Random random, std::int64_t, float x) {
    if (random.Chance(0.25F)) return;
    Placement at;
    at.x = x + random.Uniform(-12, 12);
    at.y = kLane + random.Uniform(-0.2F, 0.2F);
    at.yaw = 3.14159265F;
    at.speed_x = -static_cast<float>(kOncomingSpeed);
    AddCar(at, random, shapes);
  });
}

void Street::AddWalkers(const View& view, const Instant& now, std::vector<Shape>* shapes) const {
  for (const double pace : {1.3, -1.1}) {
    View pavement = view;
    pavement.anchor_x = view.anchor_x - pace * now.time_s;
    pavement.radius = std::min(view.radius, 60.0F);  // there are no people further away
    ForEachCell(pavement, 9, kWalker + (pace > 0 ? 64 : 0),
                [&](Random random, std::int64_t, float x) {
                  if (random.Chance(0.55F)) return;
                  Placement at;
                  const float side = random.Chance(0.5F) ? 1.0F : -1.0F;
                  at.x = x + random.Uniform(-3, 3);
                  at.y = side * random.Uniform(7.5F, 8.6F);
                  at.z = kKerb;
                  at.speed_x = static_cast<float>(pace);
                  AddPedestrian(at, random, shapes);
                });
  }
}

float Street::RoadReflectivity(double along, float y) {
  const double lane_phase = along - 9.0 * std::floor(along / 9.0);
  if (std::abs(y) < 0.07F && lane_phase < 3) return 0.6F;
  if (std::abs(std::abs(y) - 3.55F) < 0.05F) return 0.5F;
  // There are zebra stripes on the last metres before a crossing.
  const bool zebra = !IsCrossing(along) && (IsCrossing(along + 3.5) || IsCrossing(along - 3.5));
  if (zebra && y - std::floor(y) < 0.5F) return 0.6F;
  return 0.13F;
}

bool Street::IntersectGround(const View& view, const Ray& ray, Random* noise, Hit* hit) const {
  if (ray.slope > -1e-4F) return false;
  // The distance at which the ray meets the level of the pavement.
  const float top = (kKerb - ray.origin.z) * ray.inverse.z;
  const Vec3 at_top = ray.origin + top * ray.direction;
  const float grain = 0.9F + 0.2F * noise->Uniform();
  const bool beside = std::abs(at_top.y) > kHalfRoad;
  if (beside && !IsCrossing(view.anchor_x + static_cast<double>(at_top.x))) {
    if (top >= hit->distance) return false;
    const float reflectivity = std::abs(at_top.y) < kPavementEnd ? 0.3F : 0.4F;
    *hit = {top, reflectivity * grain, -ray.direction.z};
    return true;
  }
  const float road = -ray.origin.z * ray.inverse.z;
  const Vec3 p = ray.origin + road * ray.direction;
  // The ray meets the kerb, which is between the two levels.
  if (std::abs(p.y) > kHalfRoad && !beside) {
    const float kerb = ((p.y > 0 ? kHalfRoad : -kHalfRoad) - ray.origin.y) * ray.inverse.y;
    const float x = ray.origin.x + kerb * ray.direction.x;
    if (!IsCrossing(view.anchor_x + static_cast<double>(x))) {
      if (kerb >= hit->distance) return false;
      *hit = {kerb, 0.35F * grain, std::abs(ray.direction.y)};
      return true;
    }
  }
  if (road >= hit->distance) return false;
  *hit = {road, RoadReflectivity(view.anchor_x + static_cast<double>(p.x), p.y) * grain,
          -ray.direction.z};
  return true;
}

std::unique_ptr<Scene> MakeStreet(std::uint64_t seed) { return std::make_unique<Street>(seed); }

}  // namespace lidar::synth
