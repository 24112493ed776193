// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/odometry.h"

#include <algorithm>

namespace lidar::odometry {
namespace {

using std::chrono::milliseconds;

/// Edges of the cubes, as parts of the map's: for the points that enter the map, and for those that
/// are aligned. KISS-ICP, section III-B.
constexpr double kMapGrid = 0.5;
constexpr double kAlignedGrid = 1.5;
/// The cubes in which the first motion is searched, as parts of the map's.
constexpr double kFirstGrid = 4;
/// Reach and kernel, in standard deviations of the motion's error. Section III-D.
constexpr double kReach = 3;
constexpr double kKernel = 1.0 / 3;
/// More points than that make a pose no better, only later.
constexpr std::size_t kMostAligned = 4000;
/// A scan of which fewer points have a neighbour does not fit.
constexpr double kLeastInliers = 0.3;
/// How often the motion between the first two scans is computed anew.
constexpr int kFirstRounds = 4;
/// Times within a sweep at which the motion is computed.
constexpr int kPhases = 1024;
constexpr int kLostForGood = 10;  // scans
/// Scans closer than that tell nothing of the velocity.
constexpr Duration kShortestGap = milliseconds(2);
/// Beyond this the velocity may have changed: the search reaches farther in proportion.
constexpr Duration kUsualPeriod = milliseconds(150);
constexpr double kWidestSearch = 3;

/// Every n-th point, so that at most `most` are left.
Points Thin(Points points, std::size_t most) {
  const std::size_t step = (points.size() + most - 1) / most;
  if (step <= 1) return points;
  for (std::size_t i = 0; i * step < points.size(); ++i) points[i] = points[i * step];
  points.resize((points.size() + step - 1) / step);
  return points;
}

}  // namespace

const char* ToString(Tracking tracking) {
  switch (tracking) {
    case Tracking::kStarted:
      return "started";
    case Tracking::kTracking:
      return "tracking";
    case Tracking::kDegenerate:
      return "degenerate";
    case Tracking::kLost:
      break;
  }
  return "lost";
}

Odometry::Odometry(const OdometrySettings& settings)
    : settings_(settings),
      map_({settings.voxel_size_m, settings.max_range_m}),
      threshold_(settings.max_range_m),
      pose_(settings.start),
      velocity_(settings.start_velocity.value_or(Twist::Zero())) {}

Pose Odometry::PredictAt(Time t) const {
  if (!last_time_) return pose_;
  return pose_ * Exp(velocity_ * Seconds(t - *last_time_));
}

Points Odometry::SelectPoints(const TimedPoints& scan, Duration duration) const {
  const double nearest = settings_.min_range_m * settings_.min_range_m;
  const double farthest = settings_.max_range_m * settings_.max_range_m;
  const bool deskew = settings_.deskew && scan.phases.size() == scan.points.size();
  const Twist sweep = velocity_ * Seconds(duration);
  std::vector<Pose> moved;
  for (int i = 0; deskew && i <= kPhases; ++i)
    moved.push_back(Exp(sweep * (double{1} * i / kPhases - 0.5)));
  Points selected;
  selected.reserve(scan.points.size());
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const double square = scan.points[i].squaredNorm();
    if (!(square >= nearest && square <= farthest)) continue;  // NaN is neither
    if (!deskew) {
      selected.push_back(scan.points[i]);
      continue;
    }
    const float phase = std::clamp(scan.phases[i], 0.0F, 1.0F);
    selected.push_back(moved[static_cast<std::size_t>(phase * kPhases + 0.5F)] * scan.points[i]);
  }
  return selected;
}

void Odometry::StartMap(const Points& points) {
  map_ = LocalMap({settings_.voxel_size_m, settings_.max_range_m});
  Points placed;
  placed.reserve(points.size());
  for (const Eigen::Vector3d& point : points) placed.push_back(pose_ * point);
  map_.Add(placed);
  lost_scans_ = 0;
}

/// Nothing is known of the motion yet: a car may have gone farther than the fine map's cubes reach.
Pose Odometry::GuessFirstMotion(const Points& points) const {
  const double size = kFirstGrid * settings_.voxel_size_m;
  LocalMap coarse({size, settings_.max_range_m});
  coarse.Add(map_.Collect());
  return Align(Downsample(points, size / 2), &coarse, pose_, size, size / 2, settings_.registration)
      .pose;
}

/// A scan that was skewed by an unknown motion would bend the map for good.
void Odometry::StraightenFirstScan(Duration duration, const TimedPoints& second, Duration gap) {
  const double grid = kMapGrid * settings_.voxel_size_m;
  Pose found = GuessFirstMotion(Downsample(SelectPoints(second, duration), grid));
  for (int round = 0; round < kFirstRounds; ++round) {
    velocity_ = Log(pose_.Inverse() * found) / Seconds(gap);
    StartMap(Downsample(SelectPoints(*first_scan_, duration), grid));
    // Both are straightened by the same velocity now, which makes the next one better.
    const Points points =
        Downsample(SelectPoints(second, duration), kAlignedGrid * settings_.voxel_size_m);
    found = Align(Thin(points, kMostAligned), &map_, found, settings_.voxel_size_m,
                  kKernel * settings_.voxel_size_m, settings_.registration)
                .pose;
  }
  first_scan_.reset();
}

Estimate Odometry::OnScan(Time start, Duration duration, const TimedPoints& scan) {
  Estimate estimate;
  const Time middle = estimate.time = start + duration / 2;
  const Duration gap = last_time_ ? middle - *last_time_ : Duration{0};
  const bool broken = last_time_ && (gap <= Duration{0} || gap > kLongestGap);
  if (broken) {
    velocity_.setZero();
    first_scan_.reset();
  }
  Points fine = Downsample(SelectPoints(scan, duration), kMapGrid * settings_.voxel_size_m);
  if (!last_time_ || broken || map_.empty()) {
    estimate.map_restarted = last_time_.has_value();
    StartMap(fine);
    // With its velocity known it is straight already.
    if (last_time_ || !settings_.start_velocity) first_scan_ = scan;
    last_time_ = middle;
    last_scan_ = std::move(fine);
    estimate.pose = pose_;
    return estimate;
  }
  if (first_scan_) {
    StraightenFirstScan(duration, scan, gap);
    fine = Downsample(SelectPoints(scan, duration), kMapGrid * settings_.voxel_size_m);
  }
  const Points aligned =
      Thin(Downsample(fine, kAlignedGrid * settings_.voxel_size_m), kMostAligned);
  const Pose guess = PredictAt(middle);
  const double widened = std::clamp(Seconds(gap) / Seconds(kUsualPeriod), 1.0, kWidestSearch);
  const double sigma = threshold_.sigma_m() * widened;
  const Alignment found =
      Align(aligned, &map_, guess, kReach * sigma, kKernel * sigma, settings_.registration);
  estimate.inlier_share = found.inlier_share;
  estimate.iterations = found.iterations;
  last_time_ = middle;
  if (found.inlier_share < kLeastInliers) {
    estimate.tracking = Tracking::kLost;
    estimate.pose = pose_ = guess;
    if (++lost_scans_ >= kLostForGood && !fine.empty()) {
      velocity_.setZero();  // it led here
      StartMap(fine);
      first_scan_ = scan;
      estimate.map_restarted = true;
    }
    last_scan_ = std::move(fine);
    return estimate;
  }
  estimate.tracking = found.degenerate ? Tracking::kDegenerate : Tracking::kTracking;
  lost_scans_ = 0;
  threshold_.Add(guess.Inverse() * found.pose);
  if (gap >= kShortestGap) velocity_ = Log(pose_.Inverse() * found.pose) / Seconds(gap);
  estimate.pose = pose_ = found.pose;
  Points placed;
  placed.reserve(fine.size());
  for (const Eigen::Vector3d& point : fine) placed.push_back(pose_ * point);
  map_.Add(placed);
  map_.Forget(pose_.position);
  last_scan_ = std::move(fine);
  return estimate;
}

}  // namespace lidar::odometry
