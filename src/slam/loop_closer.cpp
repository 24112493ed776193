// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/slam/loop_closer.h"

#include <algorithm>
#include <cmath>

#include "src/odometry/registration.h"
#include "src/slam/pose_graph.h"

namespace lidar::slam {
namespace {

using odometry::Points;
using odometry::Pose;

/// Standard deviations of the motion from scan to scan, and of closures.
constexpr double kStep_m = 0.02;
constexpr double kStep_rad = 0.002;
constexpr double kClosure_m = 0.05;
constexpr double kClosure_rad = 0.002;
/// A closure that misses the solved poses by more is wrong.
constexpr double kContradiction_m = 1.5;
constexpr double kContradiction_rad = 0.05;
/// Largest distance of points of two maps that are the same; beyond kOverlap one map is empty
/// there.
constexpr double kSame_m = 0.4;
constexpr double kOverlap_m = 2;
constexpr double kMapVoxel_m = 1;
constexpr double kAlignedGrid_m = 1.2;
constexpr std::size_t kThinAt = 400'000;  // points of the open map

/// The surroundings of a point of one map in the other.
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
  const double step = way_.empty() ? 0 : (pose.pose.position - way_.back().pose.position).norm();
  driven_m_.push_back(way_.empty() ? 0 : driven_m_.back() + step);
  way_.push_back(pose);
  for (const Eigen::Vector3d& point : points) open_.push_back(pose.pose * point);
  if (open_.size() > kThinAt) open_ = odometry::Downsample(open_, settings_.voxel_size_m);
  if (driven_m_.back() - driven_m_[map_begin_] >= settings_.local_map_m) EndMap();
}

void LoopCloser::EndMap() {
  if (map_begin_ >= way_.size()) return;
  LocalMap map;
  // The scan at half the way is near both ends of the map.
  const double half = (driven_m_[map_begin_] + driven_m_.back()) / 2;
  const auto middle = std::lower_bound(driven_m_.begin() + static_cast<std::ptrdiff_t>(map_begin_),
                                       driven_m_.end(), half);
  map.key = static_cast<std::size_t>(middle - driven_m_.begin());
  map.way_m = *middle;
  const Pose to_key = way_[map.key].pose.Inverse();
  for (const Eigen::Vector3d& p : odometry::Downsample(open_, settings_.voxel_size_m))
    map.points.push_back(to_key * p);
  map.place = std::make_unique<Place>(map.points);
  maps_.push_back(std::move(map));
  open_.clear();
  map_begin_ = way_.size();
}

/// Returns true if the odometry's drift may hide a loop here, and the map is none of those just
/// before.
bool LoopCloser::MayBeTheSame(const LocalMap& a, const LocalMap& b) const {
  const double between = b.way_m - a.way_m;
  if (between < 3 * settings_.local_map_m) return false;
  const double apart = (way_[a.key].pose.position - way_[b.key].pose.position).norm();
  return apart < settings_.local_map_m + settings_.drift_m + settings_.drift_share * between;
}

void LoopCloser::TryToClose(const LocalMap& a, const LocalMap& b) {
  const Pose guess = way_[a.key].pose.Inverse() * way_[b.key].pose;
  const Eigen::Vector3d ahead = guess.rotation * Eigen::Vector3d::UnitX();
  const double yaw = std::atan2(ahead.y(), ahead.x());
  const auto match = Match(*a.place, *b.place, yaw, settings_.heading_range_rad);
  if (!match || match->score < settings_.least_score || match->distinct < settings_.least_distinct)
    return;
  odometry::LocalMap target({kMapVoxel_m, 1e6});
  target.Add(a.points);
  const Points source = odometry::Downsample(b.points, kAlignedGrid_m);
  odometry::RegistrationSettings registration;
  odometry::Alignment found = Align(source, &target, match->pose, 3, 1, registration);
  found = Align(source, &target, found.pose, 1, 0.3, registration);
  const Shares shares = CountShares(source, &target, found.pose);
  if (found.degenerate || shares.overlap < settings_.least_overlap ||
      shares.fit < settings_.least_fit)
    return;
  closures_.push_back({a.key, b.key, found.pose, match->score, shares.overlap, shares.fit});
}

odometry::Trajectory LoopCloser::Close() {
  EndMap();
  closures_.clear();
  for (std::size_t j = 0; j < maps_.size(); ++j)
    for (std::size_t i = 0; i < j; ++i)
      if (MayBeTheSame(maps_[i], maps_[j])) TryToClose(maps_[i], maps_[j]);
  std::vector<Pose> poses;
  for (;;) {
    if (closures_.empty()) return way_;
    poses.clear();
    for (const odometry::StampedPose& stamped : way_) poses.push_back(stamped.pose);
    std::vector<Edge> edges;
    for (std::size_t i = 1; i < poses.size(); ++i)
      edges.push_back({i - 1, i, poses[i - 1].Inverse() * poses[i], kStep_m, kStep_rad});
    for (const Closure& c : closures_)
      edges.push_back({c.from, c.to, c.pose, kClosure_m, kClosure_rad});
    if (!Optimise(edges, &poses)) return way_;
    // A closure that the others contradict is wrong.
    const std::size_t worst = FindWorst(closures_, poses);
    if (worst == closures_.size()) break;
    closures_.erase(closures_.begin() + static_cast<std::ptrdiff_t>(worst));
  }
  odometry::Trajectory closed = way_;
  for (std::size_t i = 0; i < closed.size(); ++i) closed[i].pose = poses[i];
  return closed;
}

}  // namespace lidar::slam
