// SPDX-License-Identifier: LGPL-2.1-or-later
// An endless world. The things near a position are made from the seed and the position.
#pragma once
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "src/synth/shapes.h"
#include "src/synth/trajectory.h"

namespace lidar::synth {

enum class SceneKind { kStreet, kTunnel, kField, kTown };

/// A part of the world. Its coordinates are floats relative to the anchor, which is (anchor_x,
/// anchor_y, 0). So they stay precise on a long drive. anchor_x and anchor_y are multiples of
/// kAnchorStep.
struct View {
  double anchor_x = 0;
  double anchor_y = 0;  // 0 in worlds along x
  float radius = 100;   // things further away from the anchor are left out [m]
};
/// The step between anchors [m]. The periods of ground textures divide it, so a texture stays the
/// same when the anchor moves.
constexpr double kAnchorStep = 18;

class Scene {
 public:
  virtual ~Scene() = default;
  static std::unique_ptr<Scene> Make(SceneKind kind, std::uint64_t seed);

  /// Returns the lane of the sensor's car.
  virtual TrajectorySettings Lane(double speed_mps) const = 0;
  /// Sets the view for the next calls of IntersectGround().
  virtual void MoveTo(const View&) {}
  /// Appends the fixed shapes in `view`.
  virtual void AddStatic(const View& view, std::vector<Shape>* shapes) const = 0;
  /// A time, and the position and speed of the sensor's car at this time.
  struct Instant {
    double time_s = 0;
    double ego_x = 0;
    double ego_speed = 0;
    double ego_y = 0;
  };
  /// Appends the moving shapes in `view`.
  virtual void AddMoving(const View& view, const Instant& now,
                         std::vector<Shape>* shapes) const = 0;
  /// Returns true if the ray is tested against the ground first. If this test is costly, rays that
  /// probably meet a shape are tested against the ground last.
  virtual bool GroundFirst(const Ray&) const { return true; }
  /// Intersects the ray with the ground and with other endless things. If it meets one of them
  /// nearer than hit->distance, sets `hit` and returns true.
  virtual bool IntersectGround(const View& view, const Ray& ray, Random* noise, Hit* hit) const = 0;

 protected:
  explicit Scene(std::uint64_t seed) : seed_(seed) {}

  /// Calls place(Random, index, x) for each cell of `length` metres in `view`. x is the middle of
  /// the cell, relative to the anchor.
  template <class Place>
  void ForEachCell(const View& view, double length, std::uint64_t kind, const Place& place) const {
    const auto radius = static_cast<double>(view.radius);
    const auto first = static_cast<std::int64_t>(std::floor((view.anchor_x - radius) / length));
    const auto last = static_cast<std::int64_t>(std::floor((view.anchor_x + radius) / length));
    for (std::int64_t i = first; i <= last; ++i) {
      const double middle = (static_cast<double>(i) + 0.5) * length;
      place(Random(seed_, kind, i), i, static_cast<float>(middle - view.anchor_x));
    }
  }
  std::uint64_t seed() const { return seed_; }

 private:
  std::uint64_t seed_;
};

}  // namespace lidar::synth
