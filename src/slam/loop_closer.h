// SPDX-License-Identifier: LGPL-2.1-or-later
// Takes the drift out of a drive that comes back to where it was: KISS-SLAM (Guadagnino et al.,
// 2025).
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "src/odometry/trajectory.h"
#include "src/slam/place.h"

namespace lidar::slam {

struct LoopSettings {
  double local_map_m = 40;    // way that one covers
  double voxel_size_m = 0.5;  // its points are that far apart
  /// How far the odometry may be off: loops are looked for there.
  double drift_m = 10;
  double drift_share = 0.04;  // of the way between
  double heading_range_rad = 0.25;
  double least_score = 0.3;
  double least_distinct = 1.3;
  double least_overlap = 0.35;  // part of the points that both maps have
  double least_fit = 0.6;       // part of these that lie on each other
};

/// Two places of the way that are the same.
struct Closure {
  std::size_t from = 0;  // scans, in the order they were added
  std::size_t to = 0;
  odometry::Pose pose;  // of `to` seen from `from`
  double score = 0;
  double overlap = 0;
  double fit = 0;
};

/// The closure that `poses` contradict most, where one is off by more than it may; else
/// closures.size().
std::size_t FindWorst(const std::vector<Closure>& closures,
                      const std::vector<odometry::Pose>& poses);

/// For drives of some kilometres: every local map is kept, a megabyte each. Deterministic.
class LoopCloser {
 public:
  explicit LoopCloser(const LoopSettings& settings) : settings_(settings) {}

  /// A scan in the sensor's frame, and where the odometry says it was taken.
  void AddScan(const odometry::StampedPose& pose, const odometry::Points& points);
  /// Looks for loops, and returns the way without the drift between them. The first pose stays.
  odometry::Trajectory Close();
  const std::vector<Closure>& closures() const { return closures_; }
  std::size_t local_maps() const { return maps_.size(); }

 private:
  struct LocalMap {
    std::size_t key = 0;  // the scan in whose frame the points are
    double way_m = 0;     // driven until there
    odometry::Points points;
    std::unique_ptr<Place> place;
  };
  void EndMap();
  bool MayBeTheSame(const LocalMap& a, const LocalMap& b) const;
  void TryToClose(const LocalMap& a, const LocalMap& b);

  LoopSettings settings_;
  odometry::Trajectory way_;
  std::vector<double> driven_m_;  // at each pose
  std::size_t map_begin_ = 0;     // the first scan of the open map
  odometry::Points open_;         // its points, in the frame of the odometry
  std::vector<LocalMap> maps_;
  std::vector<Closure> closures_;
};

}  // namespace lidar::slam
