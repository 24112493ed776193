// SPDX-License-Identifier: LGPL-2.1-or-later
// A simulated drive around a block, and the poses of an odometry that drifts on it.
#pragma once
#include <cmath>
#include <random>

#include "src/odometry/trajectory.h"

namespace lidar::test::block {

using odometry::Points;
using odometry::Pose;

inline constexpr double kTurn = 6.283185307179586;
// The radius of the driven circle [m].
inline constexpr double kRadius = 60;
inline constexpr int kScansOfALap = 190;

inline Pose TrueAt(int scan) {
  const double angle = kTurn * scan / kScansOfALap;
  Pose pose;
  pose.position = {kRadius * std::sin(angle), kRadius * (1 - std::cos(angle)), 0};
  pose.rotation = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ());
  return pose;
}

/// Returns the points of a flat ground and of pillars of many sizes at random places.
inline Points MakeWorld() {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> anywhere(-130, 130);
  std::uniform_real_distribution<double> size(0.5, 4);
  Points world;
  for (double x = -110; x < 110; x += 2.5)
    for (double y = -50; y < 170; y += 2.5) world.emplace_back(x, y, -1.9);
  for (int i = 0; i < 150; ++i) {
    const Eigen::Vector3d corner(anywhere(random), kRadius + anywhere(random), -1.9);
    const double wide = size(random);
    const double high = 2 * size(random);
    for (double along = 0; along < wide; along += 0.5)
      for (double z = 0; z < high; z += 0.5) {
        world.push_back(corner + Eigen::Vector3d(along, 0, z));
        world.push_back(corner + Eigen::Vector3d(0, along, z));
      }
  }
  return world;
}

inline Points SeenFrom(const Pose& pose, const Points& world, int scan) {
  const Pose back = pose.Inverse();
  Points points;
  // A scan has every 16th point of the world. The scans of a local map together have all points,
  // because the subset changes from scan to scan.
  for (std::size_t i = static_cast<std::size_t>(scan % 16); i < world.size(); i += 16)
    if ((world[i] - pose.position).squaredNorm() < 3600) points.push_back(back * world[i]);
  return points;
}

/// Returns the poses of an odometry that drifts: each of its steps is a little longer than the true
/// step and turns a little farther.
inline odometry::Trajectory Drive(int scans) {
  odometry::Trajectory way;
  for (int i = 0; i < scans; ++i) {
    odometry::StampedPose stamped;
    stamped.time = Time{} + std::chrono::milliseconds(100) * i;
    if (i > 0) {
      Pose step = TrueAt(i - 1).Inverse() * TrueAt(i);
      step.position *= 1.01;
      step.position.z() += 0.01;
      step.rotation = step.rotation * Eigen::AngleAxisd(0.0004, Eigen::Vector3d::UnitZ());
      stamped.pose = way.back().pose * step;
    }
    way.push_back(stamped);
  }
  return way;
}

inline double EndError(const odometry::Trajectory& way) {
  return (way.back().pose.position - TrueAt(static_cast<int>(way.size()) - 1).position).norm();
}

}  // namespace lidar::test::block
