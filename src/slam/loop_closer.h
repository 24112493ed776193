// SPDX-License-Identifier: LGPL-2.1-or-later
// Removes the drift of a drive that returns to an earlier place: KISS-SLAM (Guadagnino et al.,
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
  double local_map_m = 40;    // length of the path in a local map
  double voxel_size_m = 0.5;  // distance between a map's points
  std::size_t most_maps = 100;
  /// Loops are searched within this drift of the odometry, plus drift_share of the path.
  double drift_m = 10;
  double drift_share = 0.04;  // share of the path between the maps
  double heading_range_rad = 0.25;
  double least_score = 0.3;
  double least_distinct = 1.3;
  double least_overlap = 0.35;  // least share of the points that are in both maps
  double least_fit = 0.6;       // least share of these points that coincide
};

/// Two local maps of the same place.
struct Closure {
  std::size_t from = 0;  // indices of local maps, in the order of driving
  std::size_t to = 0;
  odometry::Pose pose;  // of the frame of `to` in the frame of `from`
};

/// Returns the index of the closure that `poses` contradict most, or closures.size() if none is
/// beyond its bounds.
std::size_t FindWorst(const std::vector<Closure>& closures,
                      const std::vector<odometry::Pose>& poses);

/// Keeps local maps of two megabytes each. Beyond LoopSettings::most_maps it forgets the map that
/// lies nearest to another one: memory grows with the area, not with the path. Deterministic.
class LoopCloser {
 public:
  explicit LoopCloser(const LoopSettings& settings) : settings_(settings) {}

  /// Takes a scan in the sensor's frame, with its pose from the odometry. A scan that ends a local
  /// map starts a search for loops and takes up to a second; other scans take a millisecond.
  void AddScan(const odometry::StampedPose& pose, const odometry::Points& points);
  /// Ends the open local map.
  void Finish();
  /// Returns the pose of the odometry's frame in the map. It has no drift, and jumps when a loop is
  /// closed.
  odometry::Pose MapFromOdometry() const;
  /// Returns the odometry's trajectory without its drift.
  odometry::Trajectory Correct(const odometry::Trajectory& way) const;

  const std::vector<Closure>& closures() const { return closures_; }
  std::size_t solved() const { return solved_; }  // Number of times that poses were moved.
  std::size_t local_maps() const { return maps_.size(); }

 private:
  struct Step {
    odometry::StampedPose pose;  // from the odometry
    double driven_m = 0;
  };
  struct LocalMap {
    odometry::StampedPose key;  // pose from the odometry; the points are in its frame
    odometry::Pose solved;      // pose in the map
    double driven_m = 0;        // length of the path before it
    std::size_t scans = 0;      // number of scans from the previous key to this one
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
  std::vector<Step> open_;        // steps of the open map
  odometry::Points open_points_;  // in the odometry's frame
  std::vector<LocalMap> maps_;    // the path begins in the first
  std::vector<Closure> closures_;
  std::size_t solved_ = 0;
  std::size_t scans_after_key_ = 0;  // number of scans after the key of the last map
};

}  // namespace lidar::slam
