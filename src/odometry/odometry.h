// SPDX-License-Identifier: LGPL-2.1-or-later
// Where the sensor is, from its scans alone: scans in, poses out.
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
  double max_range_m = 100;  // points farther away are left out; also the radius of the map
  double min_range_m = 1;    // nearer ones are the vehicle itself
  double voxel_size_m = 1;   // of the map
  bool deskew = true;        // move points by when they were sampled
  Pose start;                // of the first scan
  /// At the first scan, a second, in the sensor's frame; none: the first two scans tell.
  std::optional<Twist> start_velocity;
  RegistrationSettings registration;
};

/// A scan in the frame of the sensor.
struct TimedPoints {
  Points points;
  /// When each point was sampled, as part of the scan's duration: 0 to 1. Empty: not known.
  std::vector<float> phases;
  /// Which beam each point is of, in any order of the beams. Empty: not known.
  std::vector<std::uint16_t> rings;
  bool HasRings() const { return !rings.empty() && rings.size() == points.size(); }
};

enum class Tracking {
  kStarted,  // the map begins here: the first scan, or a start beside a map that did not fit
  kTracking,
  kDegenerate,  // the scene does not show the motion along one direction; the velocity is kept
                // there
  kLost,        // the scan does not fit the map; the pose is a prediction
};
const char* ToString(Tracking tracking);

struct Estimate {
  Time time{};  // the middle of the scan: an error of the velocity moves it least
  Pose pose;    // of the sensor then, as OdometrySettings::start has it
  Tracking tracking = Tracking::kStarted;
  double inlier_share = 0;
  int iterations = 0;
  bool turn_measured = false;  // by the gyroscope
  bool map_restarted = false;  // after being lost for too long
  /// Of the error since the first scan: x, y, z [m], and turns about the axes of the map [rad].
  Matrix6 covariance = Matrix6::Zero();
};

/// KISS-ICP (Vizzo et al., 2023): constant velocity, voxel grids, adaptive threshold, robust ICP
/// against a local map. It goes beyond it where scans are missing: the prediction spans the gap,
/// and a scan that does not fit does not enter the map. Deterministic; for one thread at a time.
class Odometry {
 public:
  explicit Odometry(const OdometrySettings& settings);

  /// The scan that began at `start` and took `duration`. Times must ascend: an earlier one, or a
  /// gap of more than kLongestGap, begins a new map at the last pose. Points that are not finite or
  /// out of range are left out.
  Estimate OnScan(Time start, Duration duration, const TimedPoints& scan);
  /// What a gyroscope says of the sensor at `time`: its angular velocity in the sensor's frame
  /// [rad/s], without gravity or bias in mind. Samples may come before or after the scans of their
  /// time; those that are there when a scan comes straighten it and foretell its orientation.
  void OnTurn(Time time, const Eigen::Vector3d& rate) { turns_.Add(time, rate); }
  /// Where the sensor is expected at `t`, by constant velocity, and by the gyroscope where it is.
  Pose PredictAt(Time t) const;

  const LocalMap& map() const { return map_; }
  /// The points of the last scan in the sensor's frame at its middle, thinned out.
  const Points& last_scan() const { return last_scan_; }
  static constexpr Duration kLongestGap = std::chrono::seconds(5);

 private:
  /// Points in the sensor's frame at the middle of their scan, and the normals that it shows.
  struct Surface {
    Points points;
    Points normals;  // of the first points; the others have none
  };
  RegistrationSettings SettingsFor(const TimedPoints& scan, const Pose& guess) const;
  /// How the sensor moves from one time to another, seen from where it is at the first.
  Pose MotionBetween(Time from, Time to) const;
  /// The gyroscope's turn where it is trusted and has samples.
  std::optional<Eigen::Quaterniond> KnownTurn(Time from, Time to) const;
  std::vector<Pose> SweepAround(Time middle, Duration duration) const;
  Surface SelectPoints(const TimedPoints& scan, Time middle, Duration duration) const;
  Points ThinOut(const Points& fine) const;
  void AddToMap(const Surface& fine);
  bool IsFarFromTheLastInMap() const;
  void StartMap(const Surface& fine);
  Pose GuessFirstMotion(const Points& points) const;
  void StraightenFirstScan(Duration duration, const TimedPoints& second, Time middle);
  /// Begin() takes the first scan of a map, and Match() aligns the others to it. Then Follow()
  /// takes a scan that fits, and Lose() one that does not. They move the pose; OnScan() does the
  /// rest.
  Estimate Begin(const TimedPoints& scan, const Surface& fine);
  Estimate Match(Time middle, const TimedPoints& scan, const Surface& fine);
  Alignment AlignFrom(const Pose& guess, Duration gap, const TimedPoints& scan,
                      const Surface& fine);
  bool ShowsThePlace(const Alignment& found, const Pose& guess) const;
  bool Fits(const Alignment& found, const Pose& guess, Duration gap) const;
  void Follow(const Alignment& found, const Pose& guess, Time middle, const Surface& fine);
  void Lose(const TimedPoints& scan, const Surface& fine, Estimate* estimate);
  Matrix6 CovarianceInMap() const;

  OdometrySettings settings_;
  LocalMap map_;
  MotionThreshold threshold_;
  Pose pose_;
  Pose entered_;                    // of the last scan that went into the map
  Twist velocity_ = Twist::Zero();  // a second, in the sensor's frame
  std::optional<Time> last_time_;
  Confidence confidence_;
  TurnHistory turns_;
  int lost_scans_ = 0;
  Duration lost_for_{};    // a vehicle may change its velocity meanwhile
  int fitting_scans_ = 0;  // of this map, the first one left out
  double usual_standing_share_ = 0;
  Points last_scan_;
  /// The scan that began the map, until the velocity is known that straightens it.
  std::optional<TimedPoints> first_scan_;
};

}  // namespace lidar::odometry
