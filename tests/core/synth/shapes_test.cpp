// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/synth/shapes.h"

#include <gtest/gtest.h>

#include "src/synth/props.h"
#include "src/synth/sector_index.h"

namespace lidar::synth {
namespace {

/// Returns the distance along the ray to the shape, or 0 if the ray misses the shape.
float DistanceTo(const Shape& shape, Vec3 origin, Vec3 direction) {
  const float length = std::sqrt(Dot(direction, direction));
  Random noise(1);
  Hit hit;
  hit.distance = 1000;
  if (!Intersect(shape, MakeRay(origin, (1 / length) * direction), &noise, &hit)) return 0;
  return hit.distance;
}

Shape Make(ShapeKind kind, Vec3 center, Vec3 half) {
  Shape s = MakeBox(center, half, 0.5F);
  s.kind = kind;
  return s;
}

TEST(Shapes, AreMetOnTheirSurfaces) {
  const Shape box = Make(ShapeKind::kBox, {10, 0, 0}, {1, 2, 3});
  EXPECT_FLOAT_EQ(DistanceTo(box, {}, {1, 0, 0}), 9);
  EXPECT_FLOAT_EQ(DistanceTo(box, {10, -8, 0}, {0, 1, 0}), 6);
  EXPECT_FLOAT_EQ(DistanceTo(box, {10, 0, 9}, {0, 0, -1}), 6);
  EXPECT_EQ(DistanceTo(box, {}, {0, 1, 0}), 0);
  EXPECT_EQ(DistanceTo(box, {}, {-1, 0, 0}), 0);

  const Shape column = Make(ShapeKind::kColumn, {10, 0, 0}, {0.5F, 0.5F, 3});
  EXPECT_NEAR(DistanceTo(column, {}, {1, 0, 0}), 9.5F, 1e-4F);
  EXPECT_NEAR(DistanceTo(column, {10, 0, 9}, {0, 0, -1}), 6, 1e-4F);
  EXPECT_EQ(DistanceTo(column, {0, 0, 4}, {1, 0, 0}), 0);

  const Shape bar = Make(ShapeKind::kBar, {10, 0, 0}, {4, 0.5F, 0.5F});
  EXPECT_NEAR(DistanceTo(bar, {9, -5, 0}, {0, 1, 0}), 4.5F, 1e-4F);
  EXPECT_NEAR(DistanceTo(bar, {}, {1, 0, 0}), 6, 1e-4F);

  const Shape ball = Make(ShapeKind::kEllipsoid, {10, 0, 0}, {1, 2, 3});
  EXPECT_NEAR(DistanceTo(ball, {}, {1, 0, 0}), 9, 1e-4F);
  EXPECT_NEAR(DistanceTo(ball, {10, 0, 9}, {0, 0, -1}), 6, 1e-4F);
}

TEST(Shapes, TurnAboutTheUpright) {
  Shape box = Make(ShapeKind::kBox, {10, 0, 0}, {3, 1, 1});
  box.cos_yaw = 0;
  box.sin_yaw = 1;
  EXPECT_FLOAT_EQ(DistanceTo(box, {}, {1, 0, 0}), 9);
  EXPECT_FLOAT_EQ(DistanceTo(box, {10, -8, 0}, {0, 1, 0}), 5);
}

TEST(Shapes, ACabinLeansIn) {
  const Shape cabin = Make(ShapeKind::kCabin, {10, 0, 0}, {2, 1, 0.5F});
  const float low = DistanceTo(cabin, {0, 0, -0.49F}, {1, 0, 0});
  const float high = DistanceTo(cabin, {0, 0, 0.49F}, {1, 0, 0});
  EXPECT_NEAR(low, 8.01F, 1e-3F);
  EXPECT_NEAR(high, 8.99F, 1e-3F);
}

TEST(Shapes, FoliageLetsSomeRaysThroughAndKeepsTheOthersInside) {
  const Shape crown = Make(ShapeKind::kFoliage, {10, 0, 0}, {2, 2, 2});
  Random noise(7);
  int through = 0;
  for (int i = 0; i < 2000; ++i) {
    Hit hit;
    hit.distance = 1000;
    if (!Intersect(crown, MakeRay({}, {1, 0, 0}), &noise, &hit)) {
      ++through;
      continue;
    }
    EXPECT_GE(hit.distance, 8);
    EXPECT_LE(hit.distance, 12);
  }
  // The share of rays that pass the crown is exp(-4 / 1.1), or 2.6 %.
  EXPECT_NEAR(through, 53, 20);
}

TEST(SectorIndex, LosesNoHit) {
  Random random(42);
  std::vector<Shape> shapes;
  for (int i = 0; i < 300; ++i) {
    Shape s = Make(i % 2 == 0 ? ShapeKind::kBox : ShapeKind::kColumn,
                   {random.Uniform(-60, 60), random.Uniform(-60, 60), random.Uniform(-3, 6)},
                   {random.Uniform(0.1F, 5), 0, random.Uniform(0.1F, 4)});
    s.half.y = i % 2 == 0 ? random.Uniform(0.1F, 5) : s.half.x;
    const float yaw = random.Uniform(0, 6);
    s.cos_yaw = std::cos(yaw);
    s.sin_yaw = std::sin(yaw);
    shapes.push_back(s);
  }
  const Vec3 origin{1, -2, 1.8F};
  SectorIndex index;
  index.Build(shapes, origin, 0.1F, {0, 4});
  int hits = 0;
  for (int i = 0; i < 20'000; ++i) {
    const float azimuth = random.Uniform(0, 6.2831853F);
    const float elevation = random.Uniform(-0.6F, 0.6F);
    const Ray ray = MakeRay(origin, {std::cos(azimuth) * std::cos(elevation),
                                     std::sin(azimuth) * std::cos(elevation), std::sin(elevation)});
    Hit all;
    Hit found;
    all.distance = found.distance = 200;
    for (const Shape& s : shapes) Intersect(s, ray, &random, &all);
    for (const auto& entry : index.Find(PseudoAngle(ray.direction.x, ray.direction.y))) {
      if (entry.nearest > found.distance * ray.horizontal) break;
      if (ray.slope > entry.max_slope || ray.slope < entry.min_slope) continue;
      Intersect(shapes[entry.shape], ray, &random, &found);
    }
    hits += all.distance < 200 ? 1 : 0;
    ASSERT_EQ(all.distance, found.distance) << i;
  }
  EXPECT_GT(hits, 2000);
}

}  // namespace
}  // namespace lidar::synth
