// SPDX-License-Identifier: LGPL-2.1-or-later
// Estimates the pose of the sensor from its scans.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/time.h"
#include "src/odometry/confidence.h"
#include "src/odometry/local_map.h"
#include "src/odometry/motion_threshold.h"
#include "src/odometry/registration.h"
#include "src/odometry/turn_history.h"

namespace lidar::odometry {

struct OdometrySettings {
  double max_range_m = 100;  // farther points are ignored; also the radius of the map
  double min_range_m = 1;    // nearer points are ignored, because they belong to the vehicle
  double voxel_size_m = 1;   // edge length of the cubes in the map
  bool deskew = true;        // correct points for the motion of the sensor during the scan
  Pose start;                // pose of the first scan
  /// The velocity at the first scan (per second, in the sensor's frame). If it is not set, it is
  /// computed from the first two scans.
  std::optional<Twist> start_velocity;
  RegistrationSettings registration;
};

/// The points of a scan in the frame of the sensor.
struct TimedPoints {
  Points points;
  /// The sampling time of each point as a fraction of the scan's duration, from 0 to 1. Empty if
  /// not known.
  std::vector<float> phases;
  /// The beam number of each point. Beams may be numbered in any order. Empty if not known.
  std::vector<std::uint16_t> rings;
  bool HasRings() const { return !rings.empty() && rings.size() == points.size(); }
};

enum class Tracking {
  // A map begins: with the first scan, after a gap, or because a map of few scans was lost.
  kStarted,
  kTracking,
  // The scene does not constrain the motion in a direction. In this direction, the velocity is
  // kept.
  kDegenerate,
  kLost,  // the scan does not fit the map; the pose is predicted
};
const char* ToString(Tracking tracking);

struct Estimate {
  Time time{};  // middle of the scan, where errors of the velocity matter least
  Pose pose;    // pose of the sensor at `time`, in the frame of OdometrySettings::start
  Tracking tracking = Tracking::kStarted;
  double inlier_share = 0;
  int iterations = 0;
  bool turn_measured = false;  // a gyroscope measured the rotation
  bool map_restarted = false;  // a new map begins, which is not the first map
  /// The covariance of the error relative to the first scan: x, y and z [m], and rotations about
  /// the axes of the map [rad].
  Matrix6 covariance = Matrix6::Zero();
};

/// Odometry by KISS-ICP (Vizzo et al., 2023): constant velocity, voxel grids, an adaptive
/// threshold, and robust ICP against a local map. In addition, a prediction bridges missing scans,
/// and a scan that does not fit is not added to the map. It is deterministic. Only one thread at a
/// time may use it.
class Odometry {
 public:
  explicit Odometry(const OdometrySettings& settings);

  /// Processes a scan that began at `start` and took `duration`. Scans must be in the order of
  /// time. An earlier scan, or a gap of more than kLongestGap, begins a new map at the last pose.
  /// Points that are not finite or out of range are ignored.
  Estimate OnScan(Time start, Duration duration, const TimedPoints& scan);
  /// Processes a sample of an IMU: the angular velocity [rad/s] and the specific force [m/s^2], in
  /// the sensor's frame. Gravity and bias are not yet removed. Samples may arrive before or after
  /// the scan of the same time. Samples that arrive before the scan correct its points and predict
  /// its pose.
  void OnTurn(Time time, const Eigen::Vector3d& rate,
              const Eigen::Vector3d& force = Eigen::Vector3d::Zero()) {
    turns_.Add(time, rate, force);
  }
  /// Predicts the pose at `t`, from the IMU if it has samples, otherwise with constant velocity.
  Pose PredictAt(Time t) const { return StateAt(t).pose; }

  const LocalMap& map() const { return map_; }
  /// Returns the thinned out points of the last scan. They are in the sensor's frame in the middle
  /// of the scan.
  const Points& last_scan() const { return last_scan_; }
  static constexpr Duration kLongestGap = std::chrono::seconds(5);

 private:
  RegistrationSettings SettingsFor(const TimedPoints& scan, const Pose& guess) const;
  /// Predicts the state at `t` from the state at the last scan.
  Moving StateAt(Time t) const;
  /// Moves the sensor from its state at `from` to the time `to`. Advance() uses the IMU if
  /// possible, and Glide() assumes constant velocity.
  Moving Advance(const Moving& at, Time from, Time to) const;
  Moving Glide(const Moving& at, Time from, Time to) const;
  /// Returns the rotation that the gyroscope measured, or nothing if the gyroscope is not trusted
  /// or has no samples.
  std::optional<Eigen::Quaterniond> KnownTurn(Time from, Time to) const;
  std::vector<Pose> SweepAround(const Moving& state, Time middle, Duration duration) const;
  /// `state` is the state of the sensor in the middle of the scan.
  Surface SelectPoints(const TimedPoints& scan, const Moving& state, Time middle,
                       Duration duration) const;
  Surface ThinOut(const Surface& fine) const;
  void AddToMap(const Surface& fine);
  bool IsFarFromTheLastInMap() const;
  void StartMap(const Surface& fine);
  Pose GuessFirstMotion(const Points& points) const;
  void StraightenFirstScan(Duration duration, const TimedPoints& second, Time middle);
  /// Begin() processes the first scan of a map, and Match() aligns each later scan. Match() calls
  /// Follow() if the scan fits, and Lose() if it does not. Match() and Follow() set the pose.
  Estimate Begin(const TimedPoints& scan, const Surface& fine);
  Estimate Match(Time middle, const Moving& predicted, const TimedPoints& scan,
                 const Surface& fine);
  Alignment AlignFrom(const Pose& guess, const TimedPoints& scan, const Surface& fine);
  /// Returns which fraction of the view at `pose` was also visible in the last scan in the map,
  /// from 0 to 1.
  double KnownView(const Pose& pose) const;
  bool ShowsThePlace(const Alignment& found, const Pose& guess) const;
  bool Fits(const Alignment& found, const Pose& guess, Duration gap) const;
  void Follow(const Alignment& found, const Moving& predicted, Time middle, const Surface& fine);
  void Lose(const TimedPoints& scan, const Surface& fine, Estimate* estimate);
  Matrix6 CovarianceInMap() const;

  OdometrySettings settings_;
  LocalMap map_;
  MotionThreshold threshold_;
  Pose pose_;
  Pose entered_;                    // pose of the last scan that was added to the map
  Twist velocity_ = Twist::Zero();  // per second, in the sensor's frame
  std::optional<Time> last_time_;
  Confidence confidence_;
  TurnHistory turns_;
  int lost_scans_ = 0;
  Duration lost_for_{};    // time since the last scan that fit
  int fitting_scans_ = 0;  // number of scans aligned to this map
  double usual_standing_share_ = 0;
  Points last_scan_;
  /// The first scan of the map. It is kept until the velocity is known that corrects its points.
  std::optional<TimedPoints> first_scan_;
};

}  // namespace lidar::odometry
