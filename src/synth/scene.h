// SPDX-License-Identifier: LGPL-2.1-or-later
// An endless world: things near a place are made from the seed and the place.
#pragma once
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "src/synth/shapes.h"
#include "src/synth/trajectory.h"

namespace lidar::synth {

enum class SceneKind { kStreet, kTunnel, kField, kTown };

/// A part of the world. Coordinates are floats relative to the anchor, (anchor_x, anchor_y, 0), so
/// that they stay precise on a long drive. anchor_x and anchor_y are multiples of kAnchorStep.
struct View {
  double anchor_x = 0;
  double anchor_y = 0;  // 0 in the worlds along x
  float radius = 100;   // distance from the anchor that matters
};
/// Textures of the ground repeat at divisors of this distance [m].
constexpr double kAnchorStep = 18;

class Scene {
 public:
  virtual ~Scene() = default;
  static std::unique_ptr<Scene> Make(SceneKind kind, std::uint64_t seed);

  /// The lane of the sensor's car.
  virtual TrajectorySettings Lane(double speed_mps) const = 0;
  /// Sets the view of the next calls of IntersectGround.
  virtual void MoveTo(const View&) {}
  /// Appends fixed shapes.
  virtual void AddStatic(const View& view, std::vector<Shape>* shapes) const = 0;
  /// A time, and the place and speed of the sensor's car.
  struct Instant {
    double time_s = 0;
    double ego_x = 0;
    double ego_speed = 0;
    double ego_y = 0;
  };
  /// Appends moving shapes.
  virtual void AddMoving(const View& view, const Instant& now,
                         std::vector<Shape>* shapes) const = 0;
  /// Returns true for rays that test the ground first. A costly ground is tested last by rays that
  /// more likely meet something else.
  virtual bool GroundFirst(const Ray&) const { return true; }
  /// Intersects ground and other endless things. Returns true if one is nearer than hit->distance.
  virtual bool IntersectGround(const View& view, const Ray& ray, Random* noise, Hit* hit) const = 0;

 protected:
  explicit Scene(std::uint64_t seed) : seed_(seed) {}

  /// Calls place(Random, index, x relative to the anchor) for each cell of `length` metres in view;
  /// x is the middle of the cell.
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
