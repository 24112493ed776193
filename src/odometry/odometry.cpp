// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/odometry/odometry.h"

#include <algorithm>
#include <cmath>

#include "src/odometry/scan_normals.h"

namespace lidar::odometry {
namespace {

using std::chrono::milliseconds;

/// Edge lengths of the cubes that thin out the points of the map and the aligned points, in cubes
/// of the map (KISS-ICP, section III-B).
constexpr double kMapGrid = 0.5;
constexpr double kAlignedGrid = 1.5;
/// Edge length of the cubes in the search for the first motion, in cubes of the map.
constexpr double kFirstGrid = 4;
/// Search distance and kernel scale, in standard deviations of the prediction error (KISS-ICP,
/// section III-D).
constexpr double kReach = 3;
constexpr double kKernel = 1.0 / 3;
/// The least kernel scale in cubes of the map: the roughness of grass and gravel. With a narrower
/// kernel the alignment would follow noise.
constexpr double kLeastKernel = 0.08;
/// The greatest number of aligned points. More points take time, but do not improve the pose.
constexpr std::size_t kMostAligned = 4000;
/// A scan fits the map only if at least this share of its points fits.
constexpr double kLeastInliers = 0.3;
/// A scan shows another place if the share of its upright surfaces that fit is less than this
/// fraction of the usual share. The limit decreases with motion and ends after kNewView cubes of
/// the map, because the view is new then.
constexpr double kLeastOfUsual = 0.65;
constexpr double kNewView = 30;
constexpr int kUsualScans = 10;  // number of scans that determine the usual share
/// The number of times that the motion between the first two scans is refined.
constexpr int kFirstRounds = 4;
/// The number of time steps within a scan for which the motion is computed.
constexpr int kPhases = 1024;
/// The longest time step over which the angular velocity is assumed to be constant.
constexpr Duration kTurnStep = milliseconds(100);
constexpr int kLostForGood = 10;  // after this many lost scans a new map begins
/// A map to which fewer scans have been aligned may have begun with a wrong motion, so the first
/// lost scan ends this map.
constexpr int kTrustedMap = 3;
/// Standard deviation of the prediction error for a search without a known motion [m].
constexpr double kWidestSigma = 2;
/// The greatest acceleration of a vehicle [m/s^2, rad/s^2]. kSlack, in cubes of the map, allows for
/// errors of the first motion and of alignments.
constexpr double kMostAcceleration = 30;
constexpr double kMostTurnAcceleration = 30;
constexpr double kSlack = 0.3;
/// The greatest distance at which a point counts as fitting, in cubes of the map.
constexpr double kFit = 0.2;
/// Weight of neighbours without a surface, for scans that show surfaces themselves. The weight is
/// small, because these neighbours hide that surfaces do not constrain a direction.
constexpr double kSparePointWeight = 0.05;
constexpr double kPointTurn = 0.3;
constexpr double kLeastConstraint = 0.002;
constexpr double kLeastBalance = 0.02;
/// The motion of the sensor after which a scan is added to the map: in cubes of the map, and in
/// rad.
constexpr double kMapStep = 1;
constexpr double kMapTurn = 0.09;
/// Distant ground is met by few beams, so a map of it has wrong surfaces, which would tilt the
/// sensor. Points beyond kMapReach are added to the map only if less than kLeastNear of the scan is
/// nearer.
constexpr double kMapReach = 40;  // in cubes of the map
constexpr double kLeastNear = 0.25;
/// The distance in cubes of the map below which a scan has the same lines of points as the last
/// scan in the map.
constexpr double kSameLines = 0.5;

/// The motion of the sensor during a scan. It moves a point of the scan to where the point would be
/// if it had been sampled in the middle of the scan.
class Sweep {
 public:
  /// `moved` has the motion of the sensor at kPhases + 1 times of the scan. It is empty if points
  /// are not corrected.
  Sweep(const TimedPoints& scan, std::vector<Pose> moved) : scan_(scan), moved_(std::move(moved)) {
    if (scan.phases.size() != scan.points.size()) moved_.clear();
  }
  Pose MotionOf(std::size_t point) const {
    if (moved_.empty()) return {};
    const float phase = std::clamp(scan_.phases[point], 0.0F, 1.0F);
    return moved_[static_cast<std::size_t>(phase * kPhases + 0.5F)];
  }

 private:
  const TimedPoints& scan_;
  std::vector<Pose> moved_;
};

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

std::optional<Eigen::Quaterniond> Odometry::KnownTurn(Time from, Time to) const {
  if (!turns_.trusted()) return std::nullopt;
  if (from <= to) return turns_.Between(from, to);
  const auto back = turns_.Between(to, from);
  return back ? std::optional(back->conjugate()) : std::nullopt;
}

Moving Odometry::Glide(const Moving& at, Time from, Time to) const {
  Moving moving = at;
  for (Time now = from; now != to;) {
    const Time end = now < to ? std::min(now + kTurnStep, to) : std::max(now - kTurnStep, to);
    Twist step = at.velocity * Seconds(end - now);
    if (const auto turn = KnownTurn(now, end))
      step.tail<3>() = Log({*turn, Eigen::Vector3d::Zero()}).tail<3>();
    moving.pose = moving.pose * Exp(step);
    now = end;
  }
  return moving;
}

Moving Odometry::Advance(const Moving& at, Time from, Time to) const {
  const auto moved = turns_.Move(at, from, to);
  return moved ? *moved : Glide(at, from, to);
}

Moving Odometry::StateAt(Time t) const {
  const Moving last{pose_, velocity_};
  if (!last_time_ || t - *last_time_ > kLongestGap || *last_time_ - t > kLongestGap) return last;
  return Advance(last, *last_time_, t);
}

std::vector<Pose> Odometry::SweepAround(const Moving& state, Time middle, Duration duration) const {
  std::vector<Pose> moved;
  const Pose back = state.pose.Inverse();
  for (int i = 0; settings_.deskew && i <= kPhases; ++i) {
    const Time t = middle + duration * (2 * i - kPhases) / (2 * kPhases);
    moved.push_back(back * Advance(state, middle, t).pose);
  }
  return moved;
}

/// Returns the settings for a scan. If the scan has beam numbers, its surfaces are found in the
/// scan itself.
RegistrationSettings Odometry::SettingsFor(const TimedPoints& scan, const Pose& guess) const {
  RegistrationSettings settings = settings_.registration;
  settings.fit_m = kFit * settings_.voxel_size_m;
  if (!scan.HasRings()) return settings;
  settings.spare_point_weight = kSparePointWeight;
  const double moved = (guess.position - entered_.position).norm();
  if (moved < kSameLines * settings_.voxel_size_m) settings.point_weight = kSparePointWeight;
  settings.point_turn = kPointTurn;
  settings.least_constraint = kLeastConstraint;
  settings.least_balance = kLeastBalance;
  return settings;
}

/// Returns the points to align: the first point of each cube, but at most kMostAligned points,
/// chosen evenly.
Surface Odometry::ThinOut(const Surface& fine) const {
  const auto kept = FirstOfEachCube(fine.points, kAlignedGrid * settings_.voxel_size_m);
  const std::size_t count = std::min(kept.size(), kMostAligned);
  Surface thin;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = kept[i * kept.size() / count];
    thin.points.push_back(fine.points[from]);
    if (from < fine.normals.size()) thin.normals.push_back(fine.normals[from]);
  }
  return thin;
}

Surface Odometry::SelectPoints(const TimedPoints& scan, const Moving& state, Time middle,
                               Duration duration) const {
  const double nearest = settings_.min_range_m * settings_.min_range_m;
  const double farthest = settings_.max_range_m * settings_.max_range_m;
  const Sweep sweep(scan, SweepAround(state, middle, duration));
  Points selected;
  std::vector<std::size_t> origins;  // index of each selected point in the scan
  selected.reserve(scan.points.size());
  origins.reserve(scan.points.size());
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const double square = scan.points[i].squaredNorm();
    if (!(square >= nearest && square <= farthest)) continue;  // also drops NaN
    selected.push_back(sweep.MotionOf(i) * scan.points[i]);
    origins.push_back(i);
  }
  const ScanNormals normals(scan.points, scan.rings);
  Surface fine;
  Points rest;
  for (const std::size_t k : FirstOfEachCube(selected, kMapGrid * settings_.voxel_size_m)) {
    const std::size_t i = origins[k];
    const ScanNormals::Surface surface =
        normals.At(scan.points[i], scan.HasRings() ? scan.rings[i] : std::uint16_t{0});
    if (surface.normal.isZero(0)) {
      rest.push_back(selected[k]);
    } else {
      const Pose moved = sweep.MotionOf(i);
      fine.points.push_back(moved * surface.point);
      fine.normals.push_back(moved.rotation * surface.normal);
    }
  }
  fine.points.insert(fine.points.end(), rest.begin(), rest.end());
  return fine;
}

void Odometry::AddToMap(const Surface& fine) {
  const double square = std::pow(kMapReach * settings_.voxel_size_m, 2);
  const auto is_near = [square](const Eigen::Vector3d& p) { return p.squaredNorm() <= square; };
  const auto near = std::count_if(fine.points.begin(), fine.points.end(), is_near);
  const bool take_all =
      static_cast<double>(near) < kLeastNear * static_cast<double>(fine.points.size());
  Surface placed;
  for (std::size_t i = 0; i < fine.points.size(); ++i) {
    if (!take_all && !is_near(fine.points[i])) continue;
    placed.points.push_back(pose_ * fine.points[i]);
    if (i < fine.normals.size()) placed.normals.push_back(pose_.rotation * fine.normals[i]);
  }
  map_.Add(placed.points, placed.normals);
  entered_ = pose_;
  confidence_.EnterMap();
}

/// Returns true if the sensor has moved far enough since the last scan that was added to the map.
/// Scans before that are not added, because the error of their pose would add to the map's error.
/// Also, the lines of points on the ground move with the sensor, so in the map they would hold the
/// pose back.
bool Odometry::IsFarFromTheLastInMap() const {
  const Pose moved = entered_.Inverse() * pose_;
  return moved.position.norm() >= kMapStep * settings_.voxel_size_m || Angle(moved) >= kMapTurn;
}

void Odometry::StartMap(const Surface& fine) {
  map_ = LocalMap({settings_.voxel_size_m, settings_.max_range_m});
  AddToMap(fine);
  lost_scans_ = fitting_scans_ = 0;
}

/// Estimates the motion between the first two scans by alignment to a coarse map. The motion is not
/// known yet, so a car may have moved farther than a search in the fine map finds.
Pose Odometry::GuessFirstMotion(const Points& points) const {
  const double size = kFirstGrid * settings_.voxel_size_m;
  LocalMap coarse({size, settings_.max_range_m});
  coarse.Add(map_.Collect());
  return Align(Downsample(points, size / 2), &coarse, pose_, size, size / 2, settings_.registration)
      .pose;
}

/// Corrects the first scan of the map for the motion of the sensor, which follows from the second
/// scan. An uncorrected first scan would distort the map for good.
void Odometry::StraightenFirstScan(Duration duration, const TimedPoints& second, Time middle) {
  const Duration gap = middle - *last_time_;
  Pose found = GuessFirstMotion(SelectPoints(second, StateAt(middle), middle, duration).points);
  for (int round = 0; round < kFirstRounds; ++round) {
    velocity_ = Log(pose_.Inverse() * found) / Seconds(gap);
    StartMap(SelectPoints(*first_scan_, StateAt(*last_time_), *last_time_, duration));
    // Both scans are corrected with the new velocity, which improves the next estimate of the
    // velocity.
    const Points points = ThinOut(SelectPoints(second, StateAt(middle), middle, duration)).points;
    found = Align(points, &map_, found, settings_.voxel_size_m, kKernel * settings_.voxel_size_m,
                  settings_.registration)
                .pose;
  }
  first_scan_.reset();
}

Estimate Odometry::OnScan(Time start, Duration duration, const TimedPoints& scan) {
  const Time middle = start + duration / 2;
  const Duration gap = last_time_ ? middle - *last_time_ : Duration{0};
  const bool broken = last_time_ && (gap <= Duration{0} || gap > kLongestGap);
  if (broken) {
    velocity_.setZero();
    first_scan_.reset();
  }
  const bool begins = !last_time_ || broken || map_.empty();
  if (!begins && first_scan_) StraightenFirstScan(duration, scan, middle);
  const Moving predicted = begins ? Moving{pose_, velocity_} : StateAt(middle);
  Surface fine = SelectPoints(scan, predicted, middle, duration);
  Estimate estimate = begins ? Begin(scan, fine) : Match(middle, predicted, scan, fine);
  last_time_ = estimate.time = middle;
  last_scan_ = std::move(fine.points);
  estimate.pose = pose_;
  estimate.covariance = CovarianceInMap();
  return estimate;
}

Estimate Odometry::Begin(const TimedPoints& scan, const Surface& fine) {
  Estimate estimate;
  estimate.map_restarted = last_time_.has_value();
  StartMap(fine);
  confidence_.ForgetVelocity();
  // If the velocity was known, the scan has been corrected with it already.
  const bool known = !last_time_ && settings_.start_velocity;
  if (known) {
    confidence_.SetVelocityKnown();
  } else {
    first_scan_ = scan;
  }
  return estimate;
}

/// Aligns the scan. If it does not fit with the usual search distance, searches again with the
/// largest search distance.
Alignment Odometry::AlignFrom(const Pose& guess, const TimedPoints& scan, const Surface& fine) {
  const Surface aligned = ThinOut(fine);
  const RegistrationSettings settings = SettingsFor(scan, guess);
  const auto align = [&](double sigma) {
    const double kernel = std::max(kKernel * sigma, kLeastKernel * settings_.voxel_size_m);
    const Prediction prediction{guess, confidence_.PoseInformation()};
    return Align(aligned, &map_, prediction, kReach * sigma, kernel, settings);
  };
  const double sigma = threshold_.sigma_m();
  const Alignment found = align(sigma);
  if (found.inlier_share >= kLeastInliers || sigma >= kWidestSigma) return found;
  return align(kWidestSigma);
}

double Odometry::KnownView(const Pose& pose) const {
  const double moved = (pose.position - entered_.position).norm();
  return std::max(0.0, 1 - moved / (kNewView * settings_.voxel_size_m));
}

bool Odometry::ShowsThePlace(const Alignment& found, const Pose& guess) const {
  if (fitting_scans_ < kUsualScans) return true;
  return found.standing_share >= kLeastOfUsual * KnownView(guess) * usual_standing_share_;
}

/// Returns true if enough points of the scan fit, and if a vehicle can have moved to the found
/// pose.
bool Odometry::Fits(const Alignment& found, const Pose& guess, Duration gap) const {
  if (found.inlier_share < kLeastInliers) return false;
  if (fitting_scans_ == 0) return true;  // the first motion is not limited
  if (!ShowsThePlace(found, guess)) return false;
  const Pose correction = guess.Inverse() * found.pose;
  const double square = std::pow(Seconds(gap + lost_for_), 2);
  return correction.position.norm() <=
             kMostAcceleration * square + kSlack * settings_.voxel_size_m &&
         Angle(correction) <= kMostTurnAcceleration * square;
}

Estimate Odometry::Match(Time middle, const Moving& predicted, const TimedPoints& scan,
                         const Surface& fine) {
  const Duration gap = middle - *last_time_;
  const Pose& guess = predicted.pose;
  const auto turn = KnownTurn(*last_time_, middle);
  confidence_.Predict(pose_.Inverse() * guess, gap, turn.has_value());
  const Alignment found = AlignFrom(guess, scan, fine);
  Estimate estimate;
  estimate.inlier_share = found.inlier_share;
  estimate.iterations = found.iterations;
  estimate.turn_measured = turn.has_value();
  if (!Fits(found, guess, gap)) {
    estimate.tracking = Tracking::kLost;
    pose_ = guess;
    velocity_ = predicted.velocity;
    lost_for_ += gap;
    Lose(scan, fine, &estimate);
    return estimate;
  }
  estimate.tracking = found.degenerate ? Tracking::kDegenerate : Tracking::kTracking;
  threshold_.Add(guess.Inverse() * found.pose);
  Follow(found, predicted, middle, fine);
  return estimate;
}

void Odometry::Follow(const Alignment& found, const Moving& predicted, Time middle,
                      const Surface& fine) {
  lost_scans_ = 0;
  lost_for_ = Duration{0};
  ++fitting_scans_;
  const double learned =
      std::max(1.0 / std::min(fitting_scans_, kUsualScans), 1 - KnownView(predicted.pose));
  usual_standing_share_ += learned * (found.standing_share - usual_standing_share_);
  const Duration gap = middle - *last_time_;
  turns_.Teach(*last_time_, middle, (pose_.Inverse() * found.pose).rotation,
               Exp(velocity_ * Seconds(gap)).rotation);
  const Moving before{pose_, velocity_};
  velocity_ = predicted.velocity;
  if (const auto turn = KnownTurn(*last_time_, middle))
    velocity_.tail<3>() = Log({*turn, Eigen::Vector3d::Zero()}).tail<3>() / Seconds(gap);
  const Twist correction = Log(predicted.pose.Inverse() * found.pose);
  velocity_ += confidence_.Observe(found.information, found.unobserved, correction);
  pose_ = found.pose;
  turns_.TeachForce(*last_time_, middle, before, {pose_, velocity_});
  if (IsFarFromTheLastInMap()) AddToMap(fine);
  map_.Forget(pose_.position);
}

/// Handles a scan that does not fit. Begins a new map after kLostForGood lost scans in a row, or at
/// once if few scans have been aligned to the current map.
void Odometry::Lose(const TimedPoints& scan, const Surface& fine, Estimate* estimate) {
  ++lost_scans_;
  const bool untried = fitting_scans_ < kTrustedMap;
  if ((!untried && lost_scans_ < kLostForGood) || fine.points.empty()) return;
  velocity_.setZero();  // a wrong velocity may have caused the loss
  if (untried) estimate->tracking = Tracking::kStarted;
  estimate->map_restarted = true;
  StartMap(fine);
  confidence_.ForgetVelocity();
  first_scan_ = scan;
}

Matrix6 Odometry::CovarianceInMap() const {
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = pose_.rotation.toRotationMatrix();
  return turn * confidence_.covariance() * turn.transpose();
}

}  // namespace lidar::odometry
