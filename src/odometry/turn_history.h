// SPDX-License-Identifier: LGPL-2.1-or-later
// The turns of the sensor, from its gyroscope.
#pragma once
#include <deque>
#include <optional>

#include "src/base/time.h"
#include "src/odometry/pose.h"

namespace lidar::odometry {

/// Angular velocities of the last seconds, without their bias, which the odometry teaches. They are
/// used while they predict turns at least as well as a steady turn does. So turned axes, wrong
/// units and a stuck sensor do harm for a few scans at most.
class TurnHistory {
 public:
  /// Takes an angular velocity in the sensor's frame [rad/s]. Drops a sample that is not finite or
  /// not later than the one before. A clock that goes back by a second clears the history.
  void Add(Time time, const Eigen::Vector3d& rate);
  /// Returns the turn from `from` to `to`, which is not earlier, or nothing if samples are missing
  /// between them.
  std::optional<Eigen::Quaterniond> Between(Time from, Time to) const;
  /// Compares the samples with the turn `found` from `from` to `to`, and with `steady`, the turn at
  /// the last angular velocity.
  void Teach(Time from, Time to, const Eigen::Quaterniond& found, const Eigen::Quaterniond& steady);
  bool trusted() const;
  const Eigen::Vector3d& bias() const { return bias_; }

  static constexpr Duration kKept = std::chrono::seconds(10);
  static constexpr std::size_t kMostSamples = 20'000;

 private:
  struct Sample {
    Time time{};
    Eigen::Vector3d rate;
  };
  /// Interpolates between samples. Before the first and after the last it returns that one.
  Eigen::Vector3d RateAt(Time t) const;

  std::deque<Sample> samples_;
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
  // Decaying sums of squared errors [rad^2].
  double own_squares_ = 0;
  double steady_squares_ = 0;
  int taught_ = 0;
};

}  // namespace lidar::odometry
