// SPDX-License-Identifier: LGPL-2.1-or-later
// Takes the drift out of a drive that comes back to where it was: KISS-SLAM (Guadagnino et al.,
// 2025).
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "src/odometry/trajectory.h"
#include "src/slam/place.h"

namespace lidar::slam {

struct LoopSettings {
  double local_map_m = 40;    // length of way in one local map
  double voxel_size_m = 0.5;  // distance of its points
  std::size_t most_maps = 100;
  /// Largest drift of the odometry, within which loops are searched.
  double drift_m = 10;
  double drift_share = 0.04;  // of the way between
  double heading_range_rad = 0.25;
  double least_score = 0.3;
  double least_distinct = 1.3;
  double least_overlap = 0.35;  // part of the points in both maps
  double least_fit = 0.6;       // part of those that lie on each other
};

/// Two local maps of the same place.
struct Closure {
  std::size_t from = 0;  // local maps, in the order of the way
  std::size_t to = 0;
  odometry::Pose pose;  // of the frame of `to` in that of `from`
};

/// Index of the closure that `poses` contradict most; closures.size() if all are within bounds.
std::size_t FindWorst(const std::vector<Closure>& closures,
                      const std::vector<odometry::Pose>& poses);

/// Keeps local maps, two megabytes each. Beyond LoopSettings::most_maps it forgets the one that
/// lies nearest to another: memory grows with the area, not with the way. Deterministic.
class LoopCloser {
 public:
  explicit LoopCloser(const LoopSettings& settings) : settings_(settings) {}

  /// Takes a scan in the sensor's frame, and its pose by the odometry. Where a local map ends it
  /// looks for loops, which takes a second at most; other scans take a millisecond.
  void AddScan(const odometry::StampedPose& pose, const odometry::Points& points);
  /// Ends the open local map.
  void Finish();
  /// The pose of the odometry's frame in the map, which has no drift between loops. It jumps where
  /// a loop is closed.
  odometry::Pose MapFromOdometry() const;
  /// A way by the odometry, without the drift between loops.
  odometry::Trajectory Correct(const odometry::Trajectory& way) const;

  const std::vector<Closure>& closures() const { return closures_; }
  std::size_t solved() const { return solved_; }  // how often poses were moved
  std::size_t local_maps() const { return maps_.size(); }

 private:
  struct Step {
    odometry::StampedPose pose;  // by the odometry
    double driven_m = 0;
  };
  struct LocalMap {
    odometry::StampedPose key;  // by the odometry; the points are in its frame
    odometry::Pose solved;      // in the map
    double driven_m = 0;        // length of way before it
    std::size_t scans = 0;      // between its key and the one before
    odometry::Points points;
    std::unique_ptr<Place> place;

    odometry::Pose Correction() const { return solved * key.pose.Inverse(); }
  };
  bool MayBeTheSame(const LocalMap& a, const LocalMap& b) const;
  std::vector<std::size_t> CandidatesFor(const LocalMap& b) const;
  bool TryToClose(std::size_t from, std::size_t to);
  void Solve();
  std::size_t FindNearestToAnother() const;
  void Forget(std::size_t forgotten);

  LoopSettings settings_;
  std::optional<Step> last_;
  std::vector<Step> open_;        // of the open map
  odometry::Points open_points_;  // in the frame of the odometry
  std::vector<LocalMap> maps_;    // the first is where the way begins
  std::vector<Closure> closures_;
  std::size_t solved_ = 0;
  std::size_t scans_after_key_ = 0;  // of the last map
};

}  // namespace lidar::slam
