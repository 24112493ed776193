// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/synth/props.h"

#include <cmath>

namespace lidar::synth {
namespace {

/// Adds a part of a thing to `out`. `part` is given in the frame of the thing, and `at` is the
/// position of the thing.
void AddPart(const Placement& at, Shape part, std::vector<Shape>* out) {
  const float c = std::cos(at.yaw);
  const float s = std::sin(at.yaw);
  const Vec3 p = part.center;
  part.center = {at.x + c * p.x - s * p.y, at.y + s * p.x + c * p.y, at.z + p.z};
  const float part_cos = part.cos_yaw;
  const float part_sin = part.sin_yaw;
  part.cos_yaw = c * part_cos - s * part_sin;
  part.sin_yaw = s * part_cos + c * part_sin;
  part.velocity = {at.speed_x, 0, 0};
  out->push_back(part);
}

void AddAxles(const Placement& at, float half_length, float half_width, std::vector<Shape>* out) {
  for (const float x : {-0.62F * half_length, 0.62F * half_length}) {
    Shape axle;
    axle.kind = ShapeKind::kBar;
    axle.reflectivity = 0.05F;
    axle.center = {x, 0, 0.32F};
    axle.half = {half_width - 0.02F, 0.32F, 0.32F};
    axle.cos_yaw = 0;
    axle.sin_yaw = 1;
    AddPart(at, axle, out);
  }
}

void AddPlates(const Placement& at, float half_length, std::vector<Shape>* out) {
  for (const float side : {-1.0F, 1.0F}) {
    Shape plate = MakeBox({side * half_length, 0, 0.55F}, {0.01F, 0.26F, 0.06F}, 1.6F);
    plate.surface = Surface::kRetroreflector;
    AddPart(at, plate, out);
  }
}

}  // namespace

Shape MakeBox(Vec3 center, Vec3 half, float reflectivity) {
  Shape box;
  box.center = center;
  box.half = half;
  box.reflectivity = reflectivity;
  return box;
}

void AddCar(const Placement& at, Random random, std::vector<Shape>* out) {
  const bool van = random.Chance(0.18F);
  const float half_length = van ? 2.7F : random.Uniform(1.95F, 2.4F);
  const float half_width = van ? 0.97F : random.Uniform(0.84F, 0.93F);
  const float paint = random.Chance(0.3F) ? random.Uniform(0.04F, 0.1F)  // black cars are common
                                          : random.Uniform(0.2F, 0.85F);
  const float belt = van ? 2.15F : random.Uniform(0.82F, 0.98F);
  AddPart(at,
          MakeBox({0, 0, (0.22F + belt) / 2}, {half_length, half_width, (belt - 0.22F) / 2}, paint),
          out);
  if (!van) {
    const float roof = random.Uniform(1.42F, 1.66F);
    const float half_height = (roof - belt) / 2;
    Shape cabin;
    cabin.kind = ShapeKind::kCabin;
    cabin.surface = Surface::kGlass;
    cabin.reflectivity = 0.35F;
    cabin.center = {-0.2F, 0, belt + half_height};
    cabin.half = {half_length * 0.68F, half_width - 0.08F, half_height};
    AddPart(at, cabin, out);
  }
  AddAxles(at, half_length, half_width, out);
  AddPlates(at, half_length, out);
}

void AddPedestrian(const Placement& at, Random random, std::vector<Shape>* out) {
  const float height = random.Uniform(1.45F, 1.9F);
  Shape body;
  body.kind = ShapeKind::kEllipsoid;
  body.reflectivity = random.Uniform(0.1F, 0.7F);
  body.center = {0, 0, 0.44F * height};
  body.half = {0.16F, 0.24F, 0.44F * height};
  AddPart(at, body, out);
  Shape head = body;
  head.reflectivity = 0.4F;
  head.center = {0, 0, height - 0.12F};
  head.half = {0.1F, 0.09F, 0.13F};
  AddPart(at, head, out);
}

void AddTree(const Placement& at, Random random, std::vector<Shape>* out) {
  const float trunk_height = random.Uniform(2.2F, 3.2F);
  Shape trunk;
  trunk.kind = ShapeKind::kColumn;
  trunk.reflectivity = 0.2F;
  trunk.half = {random.Uniform(0.1F, 0.24F), 0, trunk_height / 2 + 0.4F};
  trunk.half.y = trunk.half.x;
  trunk.center = {0, 0, trunk.half.z};
  AddPart(at, trunk, out);
  const float width = random.Uniform(1.2F, 2.1F);
  Shape crown;
  crown.kind = ShapeKind::kFoliage;
  crown.reflectivity = 0.45F;
  crown.half = {width, width, random.Uniform(1.2F, 1.5F) * width};
  crown.center = {0, 0, trunk_height + 0.8F * crown.half.z};
  AddPart(at, crown, out);
}

void AddLamp(const Placement& at, float arm, std::vector<Shape>* out) {
  constexpr float kHeight = 8;
  Shape pole;
  pole.kind = ShapeKind::kColumn;
  pole.reflectivity = 0.3F;
  pole.half = {0.09F, 0.09F, kHeight / 2};
  pole.center = {0, 0, kHeight / 2};
  AddPart(at, pole, out);
  Shape bar;
  bar.kind = ShapeKind::kBar;
  bar.reflectivity = 0.3F;
  bar.half = {std::abs(arm) / 2, 0.05F, 0.05F};
  bar.center = {0, arm / 2, kHeight - 0.1F};
  bar.cos_yaw = 0;
  bar.sin_yaw = 1;
  AddPart(at, bar, out);
  AddPart(at, MakeBox({0, arm, kHeight - 0.15F}, {0.15F, 0.35F, 0.08F}, 0.5F), out);
}

void AddSign(const Placement& at, std::vector<Shape>* out) {
  Shape post;
  post.kind = ShapeKind::kColumn;
  post.reflectivity = 0.3F;
  post.half = {0.035F, 0.035F, 1.4F};
  post.center = {0, 0, 1.4F};
  AddPart(at, post, out);
  Shape plate = MakeBox({-0.06F, 0, 2.45F}, {0.01F, 0.32F, 0.32F}, 2.2F);
  plate.surface = Surface::kRetroreflector;
  AddPart(at, plate, out);
}

}  // namespace lidar::synth
