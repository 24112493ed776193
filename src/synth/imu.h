// SPDX-License-Identifier: LGPL-2.1-or-later
// An inertial measurement unit that moves along the drive, with the errors that its data sheet
// states.
#pragma once
#include <random>
#include <vector>

#include "src/base/imu_sample.h"
#include "src/synth/trajectory.h"

namespace lidar::synth {

/// The errors of each axis of a gyroscope or an accelerometer, in the unit of its measurements.
struct InertialErrors {
  double noise_density = 0;     // per square root of a hertz
  double offset = 0;            // standard deviation between units
  double bias_instability = 0;  // minimum of the Allan deviation
};
struct ImuSpec {
  Duration period = std::chrono::milliseconds(10);
  InertialErrors gyroscope;      // [rad/s]
  InertialErrors accelerometer;  // [m/s^2]
};

/// A MEMS unit for robots and vehicles, such as Bosch's BMI088. It has a noise of 0.014 degrees/s
/// and 175 micro-g per root hertz, offsets of 1 degree/s and 20 milli-g, and bias instabilities of
/// 2 degrees/h and 40 micro-g.
inline constexpr ImuSpec kMemsImu = {
    std::chrono::milliseconds(10), {2.44e-4, 0.0175, 9.7e-6}, {1.72e-3, 0.196, 3.9e-4}};

/// Measures the motion in the sensor's frame. The samples depend only on the trajectory, the spec
/// and the seed.
class Imu {
 public:
  Imu(const Trajectory& trajectory, const ImuSpec& spec, std::uint64_t seed);

  /// Skips the samples before `begin`.
  void SkipTo(Duration begin);
  /// Returns the next samples before `end`. Their times count from the start of the drive.
  std::vector<ImuSample> Until(Duration end);

 private:
  /// A constant offset, and a bias that wanders around the offset (a Gauss-Markov process).
  struct Axis {
    double offset = 0;
    double wander = 0;
  };
  using Axes = std::array<Axis, 3>;

  Axes MakeAxes(const InertialErrors& errors);
  void Disturb(const InertialErrors& errors, Axes* axes, std::array<double, 3>* values);

  Trajectory trajectory_;
  ImuSpec spec_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  Axes gyroscope_;
  Axes accelerometer_;
  std::int64_t next_ = 0;  // number of the next sample
};

/// Returns the sample that a unit without errors measures at the time `t`.
ImuSample TrueMotion(const Trajectory& trajectory, Duration t);

}  // namespace lidar::synth
