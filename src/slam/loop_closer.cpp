// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/slam/loop_closer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/odometry/registration.h"
#include "src/slam/pose_graph.h"

namespace lidar::slam {
namespace {

using odometry::Points;
using odometry::Pose;

/// Standard deviations: of the motion between two scans, and of a closure.
constexpr double kStep_m = 0.02;
constexpr double kStep_rad = 0.002;
constexpr double kClosure_m = 0.05;
constexpr double kClosure_rad = 0.002;
/// A closure is wrong if it differs from the solved poses by more than this.
constexpr double kContradiction_m = 1.5;
constexpr double kContradiction_rad = 0.05;
/// A point of one map coincides with the other map if the other map has a point or a surface within
/// kSame_m. If the other map has no point within kOverlap_m, the point is outside the overlap of
/// the maps.
constexpr double kSame_m = 0.4;
constexpr double kOverlap_m = 2;
constexpr double kMapVoxel_m = 1;
constexpr double kAlignedGrid_m = 1.2;
constexpr std::size_t kThinAt = 400'000;  // the open map is thinned out if it has more points
/// A scan is ignored if the sensor has moved less than this, because it shows nothing new.
constexpr double kLeastStep_m = 0.5;
/// The number of maps that are searched for loops, nearest first.
constexpr std::size_t kMostCandidates = 8;
// The first map, the last map, and a map that can be forgotten.
constexpr std::size_t kFewestMaps = 3;

/// The overlap is the share of a map's points that are near the other map. The fit is the share of
/// these points that coincide with the other map.
struct Shares {
  double overlap = 0;
  double fit = 0;
};
Shares CountShares(const Points& points, odometry::LocalMap* map, const Pose& pose) {
  std::size_t near = 0;
  std::size_t same = 0;
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3d there = pose * p;
    const auto found = map->FindNearest(there, kOverlap_m);
    if (!found) continue;
    ++near;
    const Eigen::Vector3d off = there - found->point;
    const double distance = found->has_normal ? std::abs(found->normal.dot(off)) : off.norm();
    same += distance < kSame_m;
  }
  const auto share = [](std::size_t part, std::size_t all) {
    return all > 0 ? static_cast<double>(part) / static_cast<double>(all) : 0;
  };
  return {share(near, points.size()), share(same, near)};
}

double DistanceOf(const Pose& a, const Pose& b) { return (a.position - b.position).norm(); }

}  // namespace

std::size_t FindWorst(const std::vector<Closure>& closures, const std::vector<Pose>& poses) {
  double worst = 1;
  std::size_t found = closures.size();
  for (std::size_t i = 0; i < closures.size(); ++i) {
    const Closure& c = closures[i];
    const Pose off = c.pose.Inverse() * (poses[c.from].Inverse() * poses[c.to]);
    const double doubt =
        std::max(off.position.norm() / kContradiction_m, Angle(off) / kContradiction_rad);
    if (doubt <= worst) continue;
    worst = doubt;
    found = i;
  }
  return found;
}

void LoopCloser::AddScan(const odometry::StampedPose& pose, const Points& points) {
  Step step{pose, 0};
  if (last_) {
    const double moved = (pose.pose.position - last_->pose.pose.position).norm();
    if (moved < kLeastStep_m) return;
    step.driven_m = last_->driven_m + moved;
  }
  last_ = step;
  open_.push_back(step);
  for (const Eigen::Vector3d& point : points) open_points_.push_back(pose.pose * point);
  if (open_points_.size() > kThinAt)
    open_points_ = odometry::Downsample(open_points_, settings_.voxel_size_m);
  if (step.driven_m - open_.front().driven_m >= settings_.local_map_m) Finish();
}

void LoopCloser::Finish() {
  if (open_.empty()) return;
  // The pose of the middle scan becomes the pose of the map. The middle of the path is chosen,
  // because it is not far from either end of the map.
  const double half = (open_.front().driven_m + open_.back().driven_m) / 2;
  const auto middle = std::lower_bound(open_.begin(), open_.end(), half,
                                       [](const Step& s, double at) { return s.driven_m < at; });
  LocalMap map;
  map.key = middle->pose;
  map.solved = MapFromOdometry() * map.key.pose;
  map.driven_m = middle->driven_m;
  map.scans = scans_after_key_ + static_cast<std::size_t>(middle - open_.begin()) + 1;
  const Pose to_key = map.key.pose.Inverse();
  for (const Eigen::Vector3d& p : odometry::Downsample(open_points_, settings_.voxel_size_m))
    map.points.push_back(to_key * p);
  map.place = std::make_unique<Place>(map.points);
  scans_after_key_ = static_cast<std::size_t>(open_.end() - middle) - 1;
  maps_.push_back(std::move(map));
  open_points_.clear();
  open_.clear();
  const std::size_t newest = maps_.size() - 1;
  bool closed = false;
  for (const std::size_t candidate : CandidatesFor(maps_.back()))
    closed = TryToClose(candidate, newest) || closed;
  if (closed) Solve();
  while (maps_.size() > std::max(settings_.most_maps, kFewestMaps)) Forget(FindNearestToAnother());
}

/// Returns true if the two maps may show the same place: the drift of the odometry may explain
/// their distance, and the path between them is long enough for a loop.
bool LoopCloser::MayBeTheSame(const LocalMap& a, const LocalMap& b) const {
  const double between = b.driven_m - a.driven_m;
  if (between < 3 * settings_.local_map_m) return false;
  return DistanceOf(a.solved, b.solved) <
         settings_.local_map_m + settings_.drift_m + settings_.drift_share * between;
}

std::vector<std::size_t> LoopCloser::CandidatesFor(const LocalMap& b) const {
  std::vector<std::size_t> found;
  for (std::size_t a = 0; a < maps_.size(); ++a)
    if (MayBeTheSame(maps_[a], b)) found.push_back(a);
  std::stable_sort(found.begin(), found.end(), [&](std::size_t x, std::size_t y) {
    return DistanceOf(maps_[x].solved, b.solved) < DistanceOf(maps_[y].solved, b.solved);
  });
  if (found.size() > kMostCandidates) found.resize(kMostCandidates);
  return found;
}

bool LoopCloser::TryToClose(std::size_t from, std::size_t to) {
  const LocalMap& a = maps_[from];
  const LocalMap& b = maps_[to];
  const Pose guess = a.solved.Inverse() * b.solved;
  const Eigen::Vector3d ahead = guess.rotation * Eigen::Vector3d::UnitX();
  const double yaw = std::atan2(ahead.y(), ahead.x());
  const auto match = Match(*a.place, *b.place, yaw, settings_.heading_range_rad);
  if (!match || match->score < settings_.least_score || match->distinct < settings_.least_distinct)
    return false;
  odometry::LocalMap target({kMapVoxel_m, 1e6});
  target.Add(a.points);
  const Points source = odometry::Downsample(b.points, kAlignedGrid_m);
  odometry::RegistrationSettings registration;
  odometry::Alignment found = Align(source, &target, match->pose, 3, 1, registration);
  found = Align(source, &target, found.pose, 1, 0.3, registration);
  const Shares shares = CountShares(source, &target, found.pose);
  if (found.degenerate || shares.overlap < settings_.least_overlap ||
      shares.fit < settings_.least_fit)
    return false;
  closures_.push_back({from, to, found.pose});
  return true;
}

/// Solves for the poses of all local maps. Removes closures that contradict the solved poses.
void LoopCloser::Solve() {
  std::vector<Pose> poses;
  for (;;) {
    poses.clear();
    std::vector<Edge> edges;
    for (const LocalMap& map : maps_) poses.push_back(map.solved);
    for (std::size_t i = 1; i < maps_.size(); ++i) {
      const double steps = std::sqrt(static_cast<double>(maps_[i].scans));
      edges.push_back({i - 1, i, maps_[i - 1].key.pose.Inverse() * maps_[i].key.pose,
                       kStep_m * steps, kStep_rad * steps});
    }
    for (const Closure& c : closures_)
      edges.push_back({c.from, c.to, c.pose, kClosure_m, kClosure_rad});
    if (!Optimise(edges, &poses)) return;
    const std::size_t worst = FindWorst(closures_, poses);
    if (worst == closures_.size()) break;
    closures_.erase(closures_.begin() + static_cast<std::ptrdiff_t>(worst));
  }
  for (std::size_t i = 0; i < maps_.size(); ++i) maps_[i].solved = poses[i];
  ++solved_;
}

/// Finds the two maps that are nearest to each other, and returns the later of them. The first map
/// is never returned, because the path begins in it. The last map is never returned, because the
/// path continues from it.
std::size_t LoopCloser::FindNearestToAnother() const {
  double least = std::numeric_limits<double>::max();
  std::size_t found = 1;
  for (std::size_t i = 1; i + 1 < maps_.size(); ++i)
    for (std::size_t j = 0; j < maps_.size(); ++j) {
      const double apart = DistanceOf(maps_[i].solved, maps_[j].solved);
      if (j == i || apart > least) continue;
      least = apart;
      found = i;
    }
  return found;
}

/// Removes a map, and moves its closures to the previous map.
void LoopCloser::Forget(std::size_t forgotten) {
  const Pose to_previous = maps_[forgotten].solved.Inverse() * maps_[forgotten - 1].solved;
  maps_[forgotten + 1].scans += maps_[forgotten].scans;
  for (Closure& c : closures_) {
    if (c.to == forgotten) c.pose = c.pose * to_previous;
    if (c.from == forgotten) c.pose = to_previous.Inverse() * c.pose;
    if (c.to >= forgotten) --c.to;
    if (c.from >= forgotten) --c.from;
  }
  // If two maps have several closures, only the last of them is kept.
  std::vector<Closure> kept;
  for (auto c = closures_.rbegin(); c != closures_.rend(); ++c) {
    const bool is_new = std::none_of(kept.begin(), kept.end(), [&](const Closure& k) {
      return k.from == c->from && k.to == c->to;
    });
    if (c->from != c->to && is_new) kept.push_back(*c);
  }
  closures_.assign(kept.rbegin(), kept.rend());
  maps_.erase(maps_.begin() + static_cast<std::ptrdiff_t>(forgotten));
}

Pose LoopCloser::MapFromOdometry() const {
  return maps_.empty() ? Pose{} : maps_.back().Correction();
}

odometry::Trajectory LoopCloser::Correct(const odometry::Trajectory& way) const {
  odometry::Trajectory corrections;
  for (const LocalMap& map : maps_) corrections.push_back({map.key.time, map.Correction()});
  odometry::Trajectory corrected = way;
  if (corrections.empty()) return corrected;
  for (odometry::StampedPose& p : corrected) p.pose = InterpolateAt(corrections, p.time) * p.pose;
  return corrected;
}

}  // namespace lidar::slam
