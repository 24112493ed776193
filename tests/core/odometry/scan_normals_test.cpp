// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/scan_normals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace lidar::odometry {
namespace {

constexpr int kColumns = 512;
constexpr double kTurn = 6.283185307179586;

/// The points that a sensor of 16 beams, 3 degrees apart, measures in a world. `range_along`
/// returns the range of the world in a direction.
struct View {
  explicit View(const std::function<double(const Eigen::Vector3d&)>& range_along) {
    for (std::uint16_t ring = 0; ring < 16; ++ring)
      for (int column = 0; column < kColumns; ++column) {
        const double up = (ring * 3.0 - 25.5) / 360 * kTurn;
        const double turn = kTurn * column / kColumns;
        const Eigen::Vector3d along(std::cos(up) * std::cos(turn), std::cos(up) * std::sin(turn),
                                    std::sin(up));
        const double range = range_along(along);
        if (range > 100) continue;
        points.push_back(range * along);
        rings.push_back(ring);
      }
  }
  std::size_t CountNormals() const {
    const ScanNormals normals(points, rings);
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (!normals.At(points[i], rings[i]).normal.isZero(0)) ++count;
    return count;
  }
  Points points;
  std::vector<std::uint16_t> rings;
};

/// Returns the range to a flat ground 2 m below the sensor.
double Ground(const Eigen::Vector3d& along) {
  return along.z() < 0 ? -2 / along.z() : std::numeric_limits<double>::infinity();
}

TEST(ScanNormals, TheCirclesOnTheGroundMakeAPlane) {
  const View view(Ground);
  const ScanNormals normals(view.points, view.rings);
  for (std::size_t i = 0; i < view.points.size(); ++i) {
    const Eigen::Vector3d normal = normals.At(view.points[i], view.rings[i]).normal;
    EXPECT_NEAR(normal.z(), 1, 1e-3) << view.points[i].transpose();
  }
}

TEST(ScanNormals, MovesAPointOfGrassToTheMeanOfItsRing) {
  std::minstd_rand random(1);
  std::uniform_real_distribution<double> blade(0, 0.1);
  const View view([&](const Eigen::Vector3d& along) {
    return along.z() < 0 ? (blade(random) - 2) / along.z()
                         : std::numeric_limits<double>::infinity();
  });
  const ScanNormals normals(view.points, view.rings);
  double raw = 0;
  double moved = 0;
  double count = 0;
  for (std::size_t i = 0; i < view.points.size(); ++i) {
    if (view.points[i].head<2>().norm() > 10) continue;
    const auto surface = normals.At(view.points[i], view.rings[i]);
    if (surface.normal.isZero(0)) continue;
    raw += std::pow(view.points[i].z() + 1.95, 2);
    moved += std::pow(surface.point.z() + 1.95, 2);
    ++count;
  }
  EXPECT_GT(count, static_cast<double>(view.points.size()) / 4);
  EXPECT_LT(std::sqrt(moved / raw), 0.6);
}

TEST(ScanNormals, AWallFacesTheSensor) {
  const View view([](const Eigen::Vector3d& along) {
    return along.x() > 0.5 ? 10 / along.x() : std::numeric_limits<double>::infinity();
  });
  EXPECT_GT(view.CountNormals(), view.points.size() * 9 / 10);
  const ScanNormals normals(view.points, view.rings);
  EXPECT_NEAR(normals.At({10, 0, 10 * std::tan(1.5 / 360 * kTurn)}, 9).normal.x(), -1, 1e-3);
}

TEST(ScanNormals, APoleBeforeAWallHasNone) {
  const auto pole = [](const Eigen::Vector3d& along) {
    if (std::abs(along.y()) < 0.02 && along.x() > 0) return 5.0;
    return along.x() > 0.5 ? 10 / along.x() : std::numeric_limits<double>::infinity();
  };
  const View view(pole);
  const ScanNormals normals(view.points, view.rings);
  for (std::size_t i = 0; i < view.points.size(); ++i) {
    if (view.points[i].norm() < 6) {
      EXPECT_TRUE(normals.At(view.points[i], view.rings[i]).normal.isZero(0));
    }
  }
}

TEST(ScanNormals, AloneARingShowsNoPlane) {
  View view(Ground);
  std::vector<std::uint16_t> one(view.points.size(), 3);
  view.rings = one;
  EXPECT_EQ(view.CountNormals(), 0U);
}

TEST(ScanNormals, RingsMayBeMissingAndInAnyOrder) {
  const View all(Ground);
  View some(Ground);
  some.points.clear();
  some.rings.clear();
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    if (all.rings[i] == 2) continue;
    some.points.push_back(all.points[i]);
    some.rings.push_back(static_cast<std::uint16_t>((all.rings[i] * 7) % 16));
  }
  EXPECT_EQ(some.CountNormals(), some.points.size());
}

TEST(ScanNormals, TakesAnyPoints) {
  View view(Ground);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  view.points[7] = {nan, 0, 0};
  view.points[8] = {1e300, 0, 0};
  view.rings[9] = 65535;
  EXPECT_GT(view.CountNormals(), view.points.size() / 2);
  const ScanNormals normals(view.points, view.rings);
  for (const std::size_t i : {7U, 8U, 9U})
    EXPECT_TRUE(normals.At(view.points[i], view.rings[i]).normal.isZero(0)) << i;
  EXPECT_TRUE(ScanNormals({}, {}).At({1, 0, 0}, 0).normal.isZero(0));
  EXPECT_TRUE(ScanNormals(view.points, {1, 2}).At({1, 0, 0}, 1).normal.isZero(0));
}

}  // namespace
}  // namespace lidar::odometry
