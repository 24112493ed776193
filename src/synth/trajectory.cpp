// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/synth/trajectory.h"

namespace lidar::synth {
namespace {

constexpr double kTurn = 6.28318530717958647692;

/// A sine wave over the driven distance.
struct Wave {
  double amplitude;
  double length_m;
  double At(double s) const { return amplitude * std::sin(kTurn * s / length_m); }
  double Slope(double s) const {
    return amplitude * kTurn / length_m * std::cos(kTurn * s / length_m);
  }
};

// The lengths have no short common multiple, so that the motion does not repeat.
constexpr Wave kSwayLong{1.0, 149};
constexpr Wave kSwayShort{0.35, 43};
constexpr Wave kHeave{0.012, 9.7};
constexpr Wave kHeaveShort{0.004, 3.1};
constexpr Wave kPitch{0.006, 13.3};
constexpr Wave kRoll{0.008, 17.9};

}  // namespace

Pose Trajectory::OnRoute(Duration t) const {
  const Route::Place place = settings_.route->At(Seconds(t));
  const double s = place.distance;
  const double side = settings_.sway_m * (kSwayLong.At(s) + kSwayShort.At(s));
  const double bounce = settings_.bounce;
  Pose pose;
  pose.x = place.x - side * std::sin(place.yaw);
  pose.y = place.y + side * std::cos(place.yaw);
  pose.z = place.z + side * place.bank + settings_.sensor_height_m +
           bounce * (kHeave.At(s) + kHeaveShort.At(s));
  pose.yaw = place.yaw + std::atan(settings_.sway_m * (kSwayLong.Slope(s) + kSwayShort.Slope(s)));
  pose.pitch = bounce * kPitch.At(s) - std::atan(place.grade);
  pose.roll = bounce * kRoll.At(s) + std::atan(place.bank);
  return pose;
}

Pose Trajectory::At(Duration t) const {
  if (settings_.route) return OnRoute(t);
  const double s = settings_.speed_mps * Seconds(t);
  const double sway = settings_.sway_m;
  const double bounce = settings_.bounce;
  Pose pose;
  pose.x = s;
  pose.y = settings_.lane_y_m + sway * (kSwayLong.At(s) + kSwayShort.At(s));
  pose.z = settings_.sensor_height_m + bounce * (kHeave.At(s) + kHeaveShort.At(s));
  pose.yaw = std::atan(sway * (kSwayLong.Slope(s) + kSwayShort.Slope(s)));
  pose.pitch = bounce * kPitch.At(s);
  pose.roll = bounce * kRoll.At(s);
  return pose;
}

}  // namespace lidar::synth
