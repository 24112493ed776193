// SPDX-License-Identifier: LGPL-2.1-or-later
// Open country: a lane between ditches, grass, hedges, trees, bales, a barn, and open sky.
#include <algorithm>

#include "src/synth/props.h"
#include "src/synth/scene_makers.h"

namespace lidar::synth {
namespace {

/// A point of the ground's profile across the road. At the distance |y| from the middle of the
/// road, the ground has the height z. The profile is the same for all x. From the middle outward,
/// it consists of road, verge, ditch, meadow and hillside.
struct Knot {
  float y, z;
};
constexpr std::array<Knot, 8> kProfile = {{{0, 0.05F},
                                           {3, 0},
                                           {4.2F, -0.1F},
                                           {5, -0.75F},
                                           {5.8F, -0.1F},
                                           {30, 0.5F},
                                           {70, 6},
                                           {500, 60}}};
constexpr float kHalfRoad = 3;
constexpr float kFence = 6.6F;

float HeightAt(float y) {
  const float distance = std::abs(y);
  for (std::size_t i = 1; i < kProfile.size(); ++i) {
    const Knot& a = kProfile[i - 1];
    const Knot& b = kProfile[i];
    if (distance <= b.y) return a.z + (b.z - a.z) * (distance - a.y) / (b.y - a.y);
  }
  return kProfile.back().z;
}

enum Kind : std::uint64_t { kTree = 32, kHedge, kPost, kBale, kBarn, kPylon, kTractor };

class Field final : public Scene {
 public:
  explicit Field(std::uint64_t seed) : Scene(seed) {}

  TrajectorySettings Lane(double speed_mps) const override {
    TrajectorySettings lane;
    lane.speed_mps = speed_mps;
    lane.lane_y_m = -1.2;
    lane.sway_m = 0.2;
    lane.bounce = 2.5;
    return lane;
  }
  void AddStatic(const View& view, std::vector<Shape>* shapes) const override {
    for (const float side : {-1.0F, 1.0F}) {
      AddPlants(view, side, shapes);
      AddFence(view, side, shapes);
    }
    AddBuildings(view, shapes);
  }
  void AddMoving(const View& view, const Instant& now, std::vector<Shape>* shapes) const override;
  bool IntersectGround(const View& view, const Ray& ray, Random* noise, Hit* hit) const override;

 private:
  void AddPlants(const View& view, float side, std::vector<Shape>* shapes) const;
  void AddFence(const View& view, float side, std::vector<Shape>* shapes) const;
  void AddBuildings(const View& view, std::vector<Shape>* shapes) const;
};

void Field::AddPlants(const View& view, float side, std::vector<Shape>* shapes) const {
  const std::uint64_t offset = side > 0 ? 64 : 0;
  ForEachCell(view, 11, kTree + offset, [&](Random random, std::int64_t, float x) {
    for (const float row : {14.0F, 34.0F, 58.0F}) {
      if (random.Chance(0.55F)) continue;
      const float y = side * (row + random.Uniform(-6, 9));
      AddTree({x + random.Uniform(-4, 4), y, HeightAt(y), 0, 0}, random, shapes);
    }
  });
  ForEachCell(view, 5, kHedge + offset, [&](Random random, std::int64_t index, float x) {
    if ((index / 9) % 2 == 0 || random.Chance(0.1F)) return;
    const float y = side * 24;
    Shape bush;
    bush.kind = ShapeKind::kFoliage;
    bush.reflectivity = 0.45F;
    bush.half = {3.0F, 1.2F, random.Uniform(0.9F, 1.6F)};
    bush.center = {x, y, HeightAt(y) + 0.5F};
    shapes->push_back(bush);
  });
  ForEachCell(view, 29, kBale + offset, [&](Random random, std::int64_t, float x) {
    if (random.Chance(0.4F)) return;
    const float y = side * random.Uniform(9, 21);
    Shape bale;
    bale.kind = ShapeKind::kBar;
    bale.reflectivity = 0.5F;
    bale.half = {0.65F, 0.75F, 0.75F};
    bale.center = {x, y, HeightAt(y) + 0.75F};
    const float yaw = random.Uniform(0, 3);
    bale.cos_yaw = std::cos(yaw);
    bale.sin_yaw = std::sin(yaw);
    shapes->push_back(bale);
  });
}

void Field::AddFence(const View& view, float side, std::vector<Shape>* shapes) const {
  View near = view;
  near.radius = std::min(view.radius, 80.0F);  // farther posts are thinner than a beam
  ForEachCell(near, 3, kPost + (side > 0 ? 64 : 0), [&](Random, std::int64_t index, float x) {
    if ((index / 40) % 2 != 0) return;
    const float z = HeightAt(kFence);
    Shape post;
    post.kind = ShapeKind::kColumn;
    post.reflectivity = 0.3F;
    post.half = {0.05F, 0.05F, 0.6F};
    post.center = {x, side * kFence, z + 0.6F};
    shapes->push_back(post);
    for (const float height : {0.5F, 1.0F}) {
      shapes->push_back(
          MakeBox({x + 1.5F, side * kFence, z + height}, {1.5F, 0.02F, 0.05F}, 0.35F));
    }
  });
}

void Field::AddBuildings(const View& view, std::vector<Shape>* shapes) const {
  ForEachCell(view, 160, kBarn, [&](Random random, std::int64_t, float x) {
    const float y = (random.Chance(0.5F) ? 1.0F : -1.0F) * random.Uniform(28, 40);
    const float along = x + random.Uniform(-50, 50);
    shapes->push_back(MakeBox({along, y, HeightAt(y) + 2.5F}, {9, 5, 3}, 0.35F));
    Shape silo;
    silo.kind = ShapeKind::kColumn;
    silo.reflectivity = 0.6F;
    silo.half = {2, 2, 5};
    silo.center = {along + 13, y, HeightAt(y) + 4.5F};
    shapes->push_back(silo);
  });
  ForEachCell(view, 45, kPylon, [&](Random, std::int64_t, float x) {
    Shape pole;
    pole.kind = ShapeKind::kColumn;
    pole.reflectivity = 0.25F;
    pole.half = {0.14F, 0.14F, 4.5F};
    pole.center = {x, 8.2F, HeightAt(8.2F) + 4.4F};
    shapes->push_back(pole);
  });
}

void Field::AddMoving(const View& view, const Instant& now, std::vector<Shape>* shapes) const {
  View column = view;
  constexpr double kSpeed = 8;
  column.anchor_x = view.anchor_x + kSpeed * now.time_s;
  ForEachCell(column, 190, kTractor, [&](Random random, std::int64_t, float x) {
    Placement at;
    at.x = x + random.Uniform(-60, 60);
    at.y = 1.4F;
    at.yaw = 3.14159265F;
    at.speed_x = -static_cast<float>(kSpeed);
    AddCar(at, random, shapes);
  });
}

bool Field::IntersectGround(const View&, const Ray& ray, Random* noise, Hit* hit) const {
  // The profile is mirrored at y = 0. The ray first crosses the side from which it comes, and then
  // the side toward which it goes.
  const float toward = ray.direction.y >= 0 ? 1.0F : -1.0F;
  const float rate = std::max(std::abs(ray.direction.y), 1e-6F);
  for (int half = 0; half < 2; ++half) {
    const float sign = half == 0 ? -toward : toward;  // the side from which the ray comes is first
    for (std::size_t k = 1; k < kProfile.size(); ++k) {
      const std::size_t i = half == 0 ? kProfile.size() - k : k;
      const Knot& a = kProfile[i - 1];
      const Knot& b = kProfile[i];
      const float first = half == 0 ? -b.y : a.y;  // grows in the direction of the ray
      const float last = half == 0 ? -a.y : b.y;
      const float from = toward * ray.origin.y;
      if (last < from) continue;
      const float slope = (b.z - a.z) / (b.y - a.y);
      // The height of the ray above the ground is linear within a segment.
      const float ground = a.z + slope * (sign * ray.origin.y - a.y);
      const float fall = slope * sign * ray.direction.y - ray.direction.z;
      if (fall <= 1e-6F) continue;
      float t = (ray.origin.z - ground) / fall;
      const float y = from + t * rate;
      if (t <= 0 || y < first - 1e-3F || y > last + 1e-3F) continue;
      float reflectivity = 0.15F;
      if (a.y >= kHalfRoad) {  // blades of grass reflect the light above the soil
        const float blade = 0.12F * noise->Uniform();
        t -= std::min(blade / fall, 1.0F);
        reflectivity = 0.4F;
      }
      if (t >= hit->distance) return false;
      *hit = {t, reflectivity * (0.8F + 0.4F * noise->Uniform()),
              std::min(1.0F, fall / std::sqrt(1 + slope * slope))};
      return true;
    }
  }
  return false;
}

}  // namespace

std::unique_ptr<Scene> MakeField(std::uint64_t seed) { return std::make_unique<Field>(seed); }

}  // namespace lidar::synth
