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
  double local_map_m = 40;    // length of way in one local map
  double voxel_size_m = 0.5;  // distance of its points
  /// Largest drift of the odometry, within which loops are searched.
  double drift_m = 10;
  double drift_share = 0.04;  // of the way between
  double heading_range_rad = 0.25;
  double least_score = 0.3;
  double least_distinct = 1.3;
  double least_overlap = 0.35;  // part of the points in both maps
  double least_fit = 0.6;       // part of those that lie on each other
};

/// Two scans at the same place.
struct Closure {
  std::size_t from = 0;  // scans, in the order they were added
  std::size_t to = 0;
  odometry::Pose pose;  // pose of `to` in the frame of `from`
  double score = 0;
  double overlap = 0;
  double fit = 0;
};

/// Index of the closure that `poses` contradict most; closures.size() if all are within bounds.
std::size_t FindWorst(const std::vector<Closure>& closures,
                      const std::vector<odometry::Pose>& poses);

/// Keeps every local map, a megabyte each, so drives may have some kilometres. Deterministic.
class LoopCloser {
 public:
  explicit LoopCloser(const LoopSettings& settings) : settings_(settings) {}

  /// Takes a scan in the sensor's frame, and its pose by the odometry.
  void AddScan(const odometry::StampedPose& pose, const odometry::Points& points);
  /// Looks for loops, and returns the way without the drift between them. The first pose stays.
  odometry::Trajectory Close();
  const std::vector<Closure>& closures() const { return closures_; }
  std::size_t local_maps() const { return maps_.size(); }

 private:
  struct LocalMap {
    std::size_t key = 0;  // the scan in whose frame the points are
    double way_m = 0;     // length of way before it
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
