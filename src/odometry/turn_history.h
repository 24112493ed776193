// SPDX-License-Identifier: LGPL-2.1-or-later
// How the sensor turned, by its gyroscope.
#pragma once
#include <deque>
#include <optional>

#include "src/base/time.h"
#include "src/odometry/pose.h"

namespace lidar::odometry {

/// Angular velocities of the last seconds, without their bias, which the odometry teaches. They are
/// of use while they foretell the turns of the sensor at least as well as a steady turn does: so
/// turned axes, wrong units and a stuck sensor do no harm for longer than a few scans.
class TurnHistory {
 public:
  /// Takes an angular velocity in the sensor's frame [rad/s]. A sample that is not finite, or not
  /// later than the one before, is dropped; a clock that went back by a second begins anew.
  void Add(Time time, const Eigen::Vector3d& rate);
  /// The turn from `from` to `to`, which is not earlier. None where samples are missing between.
  std::optional<Eigen::Quaterniond> Between(Time from, Time to) const;
  /// The sensor turned by `found` from `from` to `to`; at its last angular velocity it would have
  /// turned by `steady`.
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
  /// Interpolated, and that of the first or last sample outside of them.
  Eigen::Vector3d RateAt(Time t) const;

  std::deque<Sample> samples_;
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();
  // Squares of the errors [rad^2]; old ones fade.
  double own_squares_ = 0;
  double steady_squares_ = 0;
  int taught_ = 0;
};

}  // namespace lidar::odometry
