// SPDX-License-Identifier: LGPL-2.1-or-later
// The motion of the sensor, from its gyroscope and its accelerometer.
#pragma once
#include <deque>
#include <optional>

#include "src/base/time.h"
#include "src/odometry/pose.h"

namespace lidar::odometry {

/// Samples of the last seconds, without their bias, which Teach() estimates. Angular velocities are
/// used while they predict turns at least as well as a steady turn does, and accelerations while
/// they predict the path about as well as its mean velocity does. So rotated axes, wrong units or a
/// stuck sensor do harm for a few scans at most.
class TurnHistory {
 public:
  /// Takes an angular velocity [rad/s] and the specific force [m/s^2], in the sensor's frame. Drops
  /// a sample that is not finite or not later than the previous one. A clock that goes back by a
  /// second clears the history.
  void Add(Time time, const Eigen::Vector3d& rate,
           const Eigen::Vector3d& force = Eigen::Vector3d::Zero());
  /// Returns the turn from `from` to `to`, which is not earlier, or nothing if samples are missing
  /// between them.
  std::optional<Eigen::Quaterniond> Between(Time from, Time to) const;
  /// Compares the samples with the turn `found` from `from` to `to`, and with `steady`, the turn at
  /// the last angular velocity.
  void Teach(Time from, Time to, const Eigen::Quaterniond& found, const Eigen::Quaterniond& steady);
  bool trusted() const;
  /// Moves the sensor from its state at `from` to `to`, which may be earlier. Returns nothing if
  /// samples are missing between them or accelerations are not trusted.
  std::optional<Moving> Move(const Moving& at, Time from, Time to) const;
  /// Compares the samples with the path from `before` to `found`, the states at `from` and `to`,
  /// and with the path at the mean velocity of the previous call.
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
  /// The motion between two times, in the sensor's frame at the first.
  struct Span {
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // integral of the force
    Eigen::Vector3d way = Eigen::Vector3d::Zero();       // integral of the velocity
  };
  std::optional<Span> SpanBetween(Time from, Time to) const;
  /// Interpolates between samples. Before the first it returns the first, after the last the last.
  Sample SampleAt(Time t) const;
  Moving After(const Moving& at, const Span& span, double seconds) const;

  std::deque<Sample> samples_;
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
  // Decaying sums of squared errors [rad^2].
  double own_squares_ = 0;
  double steady_squares_ = 0;
  int taught_ = 0;
  /// The force at rest, in the frame of the poses: gravity, and the accelerometer's offset.
  Eigen::Vector3d rest_ = Eigen::Vector3d::Zero();
  /// Velocities in the frame of the poses: the mean over the last span, and the velocity at its end
  /// according to the forces. The odometry's velocity does not serve, because it is filtered.
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
