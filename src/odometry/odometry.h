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
  double max_range_m = 100;  // farther points are left out; also the radius of the map
  double min_range_m = 1;    // nearer points belong to the vehicle
  double voxel_size_m = 1;   // of the map
  bool deskew = true;        // correct points for the motion since they were sampled
  Pose start;                // of the first scan
  /// Motion in a second at the first scan, in the sensor's frame. Unset: the first two scans show
  /// it.
  std::optional<Twist> start_velocity;
  RegistrationSettings registration;
};

/// A scan in the frame of the sensor.
struct TimedPoints {
  Points points;
  /// Time of each point relative to the scan's duration, 0 to 1. Empty: unknown.
  std::vector<float> phases;
  /// Beam of each point, in any order of the beams. Empty: unknown.
  std::vector<std::uint16_t> rings;
  bool HasRings() const { return !rings.empty() && rings.size() == points.size(); }
};

enum class Tracking {
  kStarted,  // the map begins here: at the first scan, after a gap, or after a map of few scans
  kTracking,
  kDegenerate,  // the scene does not show the motion along a direction; there the velocity is kept
  kLost,        // the scan does not fit the map; the pose is a prediction
};
const char* ToString(Tracking tracking);

struct Estimate {
  Time time{};  // the middle of the scan, where an error of the velocity matters least
  Pose pose;    // of the sensor at `time`, in the frame of OdometrySettings::start
  Tracking tracking = Tracking::kStarted;
  double inlier_share = 0;
  int iterations = 0;
  bool turn_measured = false;  // a gyroscope measured the rotation
  bool map_restarted = false;  // a new map begins here, and it is not the first map
  /// Covariance of the error since the first scan: x, y, z [m], and turns about the map's axes
  /// [rad].
  Matrix6 covariance = Matrix6::Zero();
};

/// KISS-ICP (Vizzo et al., 2023): constant velocity, voxel grids, adaptive threshold, and robust
/// ICP against a local map. In addition a prediction spans missing scans, and a scan that does not
/// fit does not enter the map. Deterministic; one thread at a time may use it.
class Odometry {
 public:
  explicit Odometry(const OdometrySettings& settings);

  /// Takes a scan that began at `start` and took `duration`. Times must ascend: an earlier scan, or
  /// a gap of more than kLongestGap, begins a new map at the last pose. Points that are not finite
  /// or out of range are left out.
  Estimate OnScan(Time start, Duration duration, const TimedPoints& scan);
  /// Takes a sample of an IMU: angular velocity [rad/s] and specific force [m/s^2] in the sensor's
  /// frame, with gravity and bias uncorrected. Samples may come before or after the scan of their
  /// time. Samples that precede their scan straighten it and predict its pose.
  void OnTurn(Time time, const Eigen::Vector3d& rate,
              const Eigen::Vector3d& force = Eigen::Vector3d::Zero()) {
    turns_.Add(time, rate, force);
  }
  /// Predicts the pose at `t` by constant velocity, and by the IMU if it has samples.
  Pose PredictAt(Time t) const { return StateAt(t).pose; }

  const LocalMap& map() const { return map_; }
  /// Returns the thinned out points of the last scan, in the sensor's frame at its middle.
  const Points& last_scan() const { return last_scan_; }
  static constexpr Duration kLongestGap = std::chrono::seconds(5);

 private:
  RegistrationSettings SettingsFor(const TimedPoints& scan, const Pose& guess) const;
  /// Predicts the state at `t` from the last scan's.
  Moving StateAt(Time t) const;
  /// Moves the sensor from its state at `from`: by the IMU, or Glide() at constant velocity.
  Moving Advance(const Moving& at, Time from, Time to) const;
  Moving Glide(const Moving& at, Time from, Time to) const;
  /// Returns the gyroscope's turn if the gyroscope is trusted and has samples.
  std::optional<Eigen::Quaterniond> KnownTurn(Time from, Time to) const;
  std::vector<Pose> SweepAround(const Moving& state, Time middle, Duration duration) const;
  /// `state` is that in the middle of the scan.
  Surface SelectPoints(const TimedPoints& scan, const Moving& state, Time middle,
                       Duration duration) const;
  Surface ThinOut(const Surface& fine) const;
  void AddToMap(const Surface& fine);
  bool IsFarFromTheLastInMap() const;
  void StartMap(const Surface& fine);
  Pose GuessFirstMotion(const Points& points) const;
  void StraightenFirstScan(Duration duration, const TimedPoints& second, Time middle);
  /// Begin() takes the first scan of a map, and Match() aligns each later scan. Follow() takes a
  /// scan that fits, and Lose() takes a scan that does not. Follow() and Lose() move the pose.
  Estimate Begin(const TimedPoints& scan, const Surface& fine);
  Estimate Match(Time middle, const Moving& predicted, const TimedPoints& scan,
                 const Surface& fine);
  Alignment AlignFrom(const Pose& guess, const TimedPoints& scan, const Surface& fine);
  /// Returns how much of the view at `pose` the last scan in the map also shows: 0 to 1.
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
  Pose entered_;                    // pose of the last scan that entered the map
  Twist velocity_ = Twist::Zero();  // per second, in the sensor's frame
  std::optional<Time> last_time_;
  Confidence confidence_;
  TurnHistory turns_;
  int lost_scans_ = 0;
  Duration lost_for_{};    // time since the last fit, in which the velocity may have changed
  int fitting_scans_ = 0;  // of this map, without its first scan
  double usual_standing_share_ = 0;
  Points last_scan_;
  /// The scan that began the map. It is kept until the velocity that straightens it is known.
  std::optional<TimedPoints> first_scan_;
};

}  // namespace lidar::odometry
