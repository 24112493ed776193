// SPDX-License-Identifier: LGPL-2.1-or-later
// Removes the drift of a trajectory that returns to an earlier place, as in KISS-SLAM (Guadagnino
// et al., 2025).
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
  double voxel_size_m = 0.5;  // distance between the points of a map
  std::size_t most_maps = 100;
  /// Loops are searched for as if the odometry had drifted by at most this distance, plus
  /// `drift_share` of the path.
  double drift_m = 10;
  double drift_share = 0.04;  // as a fraction of the path between the two maps
  double heading_range_rad = 0.25;
  double least_score = 0.3;
  double least_distinct = 1.3;
  double least_overlap = 0.35;  // least share of the points that are in both maps
  double least_fit = 0.6;       // least share of these points that coincide
};

/// A pair of local maps that show the same place.
struct Closure {
  std::size_t from = 0;  // indices of local maps, sorted by time
  std::size_t to = 0;
  odometry::Pose pose;  // pose of the map `to` in the frame of the map `from`
};

/// Returns the index of the closure that differs most from `poses`. Returns closures.size() if no
/// closure differs by more than the limits.
std::size_t FindWorst(const std::vector<Closure>& closures,
                      const std::vector<odometry::Pose>& poses);

/// Finds loops between local maps, and corrects the drift. A local map takes about two megabytes.
/// If there are more maps than LoopSettings::most_maps, a map that is near another map is
/// forgotten. So the memory grows with the area and not with the length of the path. The results
/// are deterministic.
class LoopCloser {
 public:
  explicit LoopCloser(const LoopSettings& settings) : settings_(settings) {}

  /// Adds a scan. `points` are in the sensor's frame, and `pose` comes from the odometry. If the
  /// scan ends a local map, loops are searched, which takes up to a second. Other scans take about
  /// a millisecond.
  void AddScan(const odometry::StampedPose& pose, const odometry::Points& points);
  /// Ends the open local map and searches it for loops.
  void Finish();
  /// Returns the pose of the odometry's frame in the map. The map has no drift, so this pose jumps
  /// when a loop is closed.
  odometry::Pose MapFromOdometry() const;
  /// Returns the trajectory `way` of the odometry, corrected for its drift.
  odometry::Trajectory Correct(const odometry::Trajectory& way) const;

  const std::vector<Closure>& closures() const { return closures_; }
  std::size_t solved() const { return solved_; }  // how many times poses were moved
  std::size_t local_maps() const { return maps_.size(); }

 private:
  struct Step {
    odometry::StampedPose pose;  // pose from the odometry
    double driven_m = 0;
  };
  struct LocalMap {
    odometry::StampedPose key;  // pose from the odometry, of the frame of `points`
    odometry::Pose solved;      // corrected pose in the map
    double driven_m = 0;        // length of the path before this map
    std::size_t scans = 0;      // number of scans since the key of the previous map
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
  std::vector<Step> open_;        // the scans of the open map
  odometry::Points open_points_;  // in the frame of the odometry
  std::vector<LocalMap> maps_;    // in the order of the path
  std::vector<Closure> closures_;
  std::size_t solved_ = 0;
  std::size_t scans_after_key_ = 0;  // number of scans since the key of the last map
};

}  // namespace lidar::slam
