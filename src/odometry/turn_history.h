// SPDX-License-Identifier: LGPL-2.1-or-later
// Computes the motion of the sensor from its gyroscope and its accelerometer.
#pragma once
#include <deque>
#include <optional>

#include "src/base/time.h"
#include "src/odometry/pose.h"

namespace lidar::odometry {

/// The IMU samples of the last seconds. They are used without their bias, which Teach() estimates.
/// Angular velocities are trusted while they predict rotations at least as well as a constant
/// angular velocity does. Accelerations are trusted while they predict the path about as well as
/// its mean velocity does. So rotated axes, wrong units or a stuck sensor do harm for a few scans
/// at most.
class TurnHistory {
 public:
  /// Adds an angular velocity [rad/s] and a specific force [m/s^2], both in the sensor's frame.
  /// Ignores a sample that is not finite, or not later than the sample before it. If the clock goes
  /// back by a second or more, clears the history.
  void Add(Time time, const Eigen::Vector3d& rate,
           const Eigen::Vector3d& force = Eigen::Vector3d::Zero());
  /// Returns the rotation from `from` to `to`, which must not be earlier. Returns nothing if
  /// samples are missing in this time.
  std::optional<Eigen::Quaterniond> Between(Time from, Time to) const;
  /// Compares the samples with the rotation `found` from `from` to `to`. Also compares `steady`,
  /// the rotation at the last angular velocity, with `found`.
  void Teach(Time from, Time to, const Eigen::Quaterniond& found, const Eigen::Quaterniond& steady);
  bool trusted() const;
  /// Moves the sensor from its state at `from` to the time `to`, which may be earlier. Returns
  /// nothing if samples are missing in this time, or if accelerations are not trusted.
  std::optional<Moving> Move(const Moving& at, Time from, Time to) const;
  /// Compares the samples with the path from `before` to `found`, the states at `from` and `to`.
  /// Also compares the path at the mean velocity of the previous call with this path.
  void TeachForce(Time from, Time to, const Moving& before, const Moving& found);
  bool force_trusted() const;
  const Eigen::Vector3d& bias() const { return bias_; }

  static constexpr Duration kKept = std::chrono::seconds(10);
  static constexpr std::size_t kMostSamples = 20'000;

 private:
  struct Sample {
    Time time{};
    Eigen::Vector3d rate;
    Eigen::Vector3d force;
  };
  /// The motion between two times, in the sensor's frame at the first of them.
  struct Span {
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // integral of the force
    Eigen::Vector3d way = Eigen::Vector3d::Zero();       // integral of the velocity
  };
  std::optional<Span> SpanBetween(Time from, Time to) const;
  /// Interpolates between samples. Returns the first sample for an earlier time, and the last
  /// sample for a later time.
  Sample SampleAt(Time t) const;
  Moving After(const Moving& at, const Span& span, double seconds) const;

  std::deque<Sample> samples_;
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
  // Decaying sums of squared errors [rad^2].
  double own_squares_ = 0;
  double steady_squares_ = 0;
  int taught_ = 0;
  /// The force at rest, in the frame of the poses: gravity and the offset of the accelerometer.
  Eigen::Vector3d rest_ = Eigen::Vector3d::Zero();
  /// Two velocities in the frame of the poses: the mean velocity over the last span, and the
  /// velocity at its end according to the forces. The velocity of the odometry is not used here,
  /// because it is filtered.
  struct Reached {
    Eigen::Vector3d mean;
    Eigen::Vector3d velocity;
  };
  std::optional<Reached> reached_;
  // Decaying sums of squared errors of the path [m^2].
  double force_squares_ = 0;
  double mean_squares_ = 0;
  int forces_taught_ = 0;
};

}  // namespace lidar::odometry
