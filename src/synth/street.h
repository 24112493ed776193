// SPDX-License-Identifier: LGPL-2.1-or-later
// A straight street along x. Towns make their streets from its parts, and bend them.
#pragma once
#include "src/synth/scene.h"

namespace lidar::synth {

/// The length of a block [m], which is a house with its plot. Every seventh block is a crossing.
constexpr double kBlock = kAnchorStep;
constexpr std::int64_t kBlocksToCrossing = 7;
constexpr double kCrossingSpacing = kBlock * kBlocksToCrossing;
constexpr double kFirstCrossing = 3.5 * kBlock;  // middle of the first crossing [m]
constexpr float kStreetHalfRoad = 5.8F;          // two lanes and two rows of parked cars
constexpr float kStreetKerb = 0.14F;
constexpr float kStreetLane = 1.75F;  // middle of a lane
constexpr float kPavementEnd = 9.2F;

class Street final : public Scene {
 public:
  explicit Street(std::uint64_t seed) : Scene(seed) {}

  TrajectorySettings Lane(double speed_mps) const override;
  void AddStatic(const View& view, std::vector<Shape>* shapes) const override;
  void AddMoving(const View& view, const Instant& now, std::vector<Shape>* shapes) const override;
  bool IntersectGround(const View& view, const Ray& ray, Random* noise, Hit* hit) const override;

  void AddHouses(const View& view, float side, std::vector<Shape>* shapes) const;
  void AddParked(const View& view, float side, std::vector<Shape>* shapes) const;
  /// Adds trees, lamps, signs and bins.
  void AddFurniture(const View& view, float side, std::vector<Shape>* shapes) const;
  /// Adds the cars on the left lane, which drive toward -x.
  void AddOncoming(const View& view, const Instant& now, std::vector<Shape>* shapes) const;
  void AddWalkers(const View& view, const Instant& now, std::vector<Shape>* shapes) const;

  /// Returns the reflectivity of asphalt or road paint. `along` is the position along the street,
  /// and `lateral` is the distance from its middle.
  static float RoadReflectivity(double along, float lateral);

 private:
  void AddOwnLane(const View& view, const Instant& now, std::vector<Shape>* shapes) const;
};

}  // namespace lidar::synth
