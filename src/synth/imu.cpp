// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/synth/imu.h"

#include <cmath>

namespace lidar::synth {
namespace {

using Vector = std::array<double, 3>;

constexpr double kGravity = 9.80665;
/// Half of a sample period. Differences over a whole period average the motion, as a real unit
/// does.
constexpr Duration kStep = std::chrono::milliseconds(5);
/// Correlation time of the bias [s].
constexpr double kWanderTime = 100;
/// The peak of the Allan deviation of a Gauss-Markov process, divided by the standard deviation of
/// the process.
constexpr double kAllanPeak = 0.618;

Vector Cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Returns the vector part of conj(a) b. For a small rotation from a to b, this is half of the
/// rotation, in the frame of a.
Vector HalfTurn(const std::array<double, 4>& a, const std::array<double, 4>& b) {
  const Vector va = {a[0], a[1], a[2]};
  const Vector vb = {b[0], b[1], b[2]};
  const Vector across = Cross(vb, va);
  Vector half;
  for (std::size_t i = 0; i < 3; ++i) half[i] = a[3] * vb[i] - b[3] * va[i] + across[i];
  const double w = a[3] * b[3] + a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  if (w < 0)
    for (double& v : half) v = -v;
  return half;
}

/// Converts `v` from the frame of the world to the frame of the pose `q`.
Vector TurnBack(const std::array<double, 4>& q, const Vector& v) {
  const Vector axis = {-q[0], -q[1], -q[2]};
  const Vector once = Cross(axis, v);
  const Vector twice = Cross(axis, once);
  Vector turned;
  for (std::size_t i = 0; i < 3; ++i) turned[i] = v[i] + 2 * (q[3] * once[i] + twice[i]);
  return turned;
}

}  // namespace

ImuSample TrueMotion(const Trajectory& trajectory, Duration t) {
  const Pose before = trajectory.At(t - kStep);
  const Pose now = trajectory.At(t);
  const Pose after = trajectory.At(t + kStep);
  const double h = Seconds(kStep);
  const auto second = [h](double a, double b, double c) { return (a - 2 * b + c) / (h * h); };
  const Vector felt = {second(before.x, now.x, after.x), second(before.y, now.y, after.y),
                       second(before.z, now.z, after.z) + kGravity};
  ImuSample sample;
  sample.time += t;
  sample.acceleration = TurnBack(now.ToQuaternion(), felt);
  sample.angular_velocity = HalfTurn(before.ToQuaternion(), after.ToQuaternion());
  // This divides half of the rotation by half of its time.
  for (double& v : sample.angular_velocity) v /= h;
  return sample;
}

Imu::Imu(const Trajectory& trajectory, const ImuSpec& spec, std::uint64_t seed)
    : trajectory_(trajectory),
      spec_(spec),
      random_(seed),
      gyroscope_(MakeAxes(spec.gyroscope)),
      accelerometer_(MakeAxes(spec.accelerometer)) {}

Imu::Axes Imu::MakeAxes(const InertialErrors& errors) {
  Axes axes;
  for (Axis& axis : axes) {
    axis.offset = errors.offset * normal_(random_);
    axis.wander = errors.bias_instability / kAllanPeak * normal_(random_);
  }
  return axes;
}

void Imu::Disturb(const InertialErrors& errors, Axes* axes, Vector* values) {
  const double period = Seconds(spec_.period);
  const double kept = std::exp(-period / kWanderTime);
  const double step = errors.bias_instability / kAllanPeak * std::sqrt(1 - kept * kept);
  // The bandwidth of the samples is half their rate.
  const double noise = errors.noise_density * std::sqrt(0.5 / period);
  for (std::size_t i = 0; i < 3; ++i) {
    Axis& axis = (*axes)[i];
    axis.wander = kept * axis.wander + step * normal_(random_);
    (*values)[i] += axis.offset + axis.wander + noise * normal_(random_);
  }
}

void Imu::SkipTo(Duration begin) {
  next_ = std::max(next_, (begin + spec_.period - Duration{1}) / spec_.period);
}

std::vector<ImuSample> Imu::Until(Duration end) {
  std::vector<ImuSample> samples;
  for (; next_ * spec_.period < end; ++next_) {
    ImuSample sample = TrueMotion(trajectory_, next_ * spec_.period);
    Disturb(spec_.gyroscope, &gyroscope_, &sample.angular_velocity);
    Disturb(spec_.accelerometer, &accelerometer_, &sample.acceleration);
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace lidar::synth
