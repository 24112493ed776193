// SPDX-License-Identifier: LGPL-2.1-or-later
// A road tunnel. Its walls are the same for kilometres, so that odometry fails in it.
#include "src/synth/props.h"
#include "src/synth/scene_makers.h"

namespace lidar::synth {
namespace {

constexpr float kRadius = 6.0F;
constexpr float kAxisHeight = 1.4F;  // height of the centre of the circular shell
constexpr float kLane = 1.85F;
constexpr float kHalfRoad = 4.2F;
constexpr float kKerb = 0.25F;
constexpr double kSection = 9;  // length of a section of the lining, from joint to joint
constexpr double kOncomingSpeed = 20;

enum Kind : std::uint64_t { kRig = 16, kFan, kPost, kTraffic };

class Tunnel final : public Scene {
 public:
  explicit Tunnel(std::uint64_t seed) : Scene(seed) {}

  TrajectorySettings Lane(double speed_mps) const override {
    TrajectorySettings lane;
    lane.speed_mps = speed_mps;
    lane.lane_y_m = -static_cast<double>(kLane);
    lane.sway_m = 0.15;
    lane.bounce = 0.6;
    return lane;
  }
  void AddStatic(const View& view, std::vector<Shape>* shapes) const override;
  void AddMoving(const View& view, const Instant& now, std::vector<Shape>* shapes) const override;
  bool IntersectGround(const View& view, const Ray& ray, Random* noise, Hit* hit) const override;
};

void Tunnel::AddStatic(const View& view, std::vector<Shape>* shapes) const {
  ForEachCell(view, 12, kRig, [&](Random, std::int64_t, float x) {
    for (const float side : {-1.0F, 1.0F}) {
      shapes->push_back(MakeBox({x, side * 2.3F, 6.55F}, {0.6F, 0.15F, 0.1F}, 0.6F));  // lamp
      Shape tray;  // for cables along the wall
      tray.kind = ShapeKind::kBar;
      tray.reflectivity = 0.4F;
      tray.center = {x, side * 5.35F, 3.4F};
      tray.half = {6, 0.12F, 0.12F};
      shapes->push_back(tray);
    }
  });
  ForEachCell(view, 72, kFan, [&](Random random, std::int64_t, float x) {
    for (const float side : {-1.0F, 1.0F}) {
      Shape fan;
      fan.kind = ShapeKind::kBar;
      fan.reflectivity = 0.5F;
      fan.center = {x + random.Uniform(-8, 8), side * 1.2F, 6.0F};
      fan.half = {1.6F, 0.5F, 0.5F};
      shapes->push_back(fan);
    }
    const float niche = x + random.Uniform(-20, 20);
    shapes->push_back(MakeBox({niche, -5.5F, 1.4F}, {0.6F, 0.35F, 1.1F}, 0.7F));  // emergency call
  });
  ForEachCell(view, 24, kPost, [&](Random, std::int64_t, float x) {
    for (const float side : {-1.0F, 1.0F}) {
      Shape mark = MakeBox({x, side * 5.75F, 1.0F}, {0.02F, 0.1F, 0.1F}, 2.0F);
      mark.surface = Surface::kRetroreflector;
      shapes->push_back(mark);
    }
  });
}

void Tunnel::AddMoving(const View& view, const Instant& now, std::vector<Shape>* shapes) const {
  for (const double gap : {-28.0, 35.0, 74.0}) {
    Placement at;
    at.x = static_cast<float>(now.ego_x - view.anchor_x + gap);
    at.y = -kLane;
    at.speed_x = static_cast<float>(now.ego_speed);
    AddCar(at, Random(seed(), kTraffic, static_cast<std::int64_t>(gap)), shapes);
  }
  View column = view;
  column.anchor_x = view.anchor_x + kOncomingSpeed * now.time_s;
  ForEachCell(column, 63, kTraffic + 64, [&](Random random, std::int64_t, float x) {
    Placement at;
    at.x = x + random.Uniform(-18, 18);
    at.y = kLane;
    at.yaw = 3.14159265F;
    at.speed_x = -static_cast<float>(kOncomingSpeed);
    AddCar(at, random, shapes);
  });
}

bool Tunnel::IntersectGround(const View&, const Ray& ray, Random* noise, Hit* hit) const {
  const Vec3 o{ray.origin.x, ray.origin.y, ray.origin.z - kAxisHeight};
  const Vec3 d = ray.direction;
  // The ray starts inside the shell, so the far intersection counts.
  const float a = d.y * d.y + d.z * d.z + 1e-12F;
  const float b = o.y * d.y + o.z * d.z;
  const float root = std::sqrt(b * b - a * (o.y * o.y + o.z * o.z - kRadius * kRadius));
  Hit shell{(root - b) / a, 0.35F, root / kRadius};
  const float x = o.x + shell.distance * d.x;
  const float joint =
      x - static_cast<float>(kSection) * std::floor(x / static_cast<float>(kSection));
  if (joint < 0.06F) shell.reflectivity = 0.08F;
  if (d.z < -1e-4F) {
    const float road = -ray.origin.z * ray.inverse.z;
    const float side = ray.origin.y + road * d.y;
    const float walk = (kKerb - ray.origin.z) * ray.inverse.z;
    if (std::abs(ray.origin.y + walk * d.y) > kHalfRoad) {
      if (walk < shell.distance) shell = {walk, 0.3F, -d.z};
    } else if (std::abs(side) > kHalfRoad) {
      const float kerb = ((side > 0 ? kHalfRoad : -kHalfRoad) - ray.origin.y) * ray.inverse.y;
      shell = {kerb, 0.35F, std::abs(d.y)};
    } else if (road < shell.distance) {
      const bool line = std::abs(side) < 0.08F || std::abs(std::abs(side) - 3.9F) < 0.07F;
      shell = {road, line ? 0.6F : 0.14F, -d.z};
    }
  }
  shell.reflectivity *= 0.92F + 0.16F * noise->Uniform();
  if (!(shell.distance < hit->distance)) return false;
  *hit = shell;
  return true;
}

}  // namespace

std::unique_ptr<Scene> MakeTunnel(std::uint64_t seed) { return std::make_unique<Tunnel>(seed); }

}  // namespace lidar::synth
