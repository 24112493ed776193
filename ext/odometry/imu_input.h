// SPDX-License-Identifier: LGPL-2.1-or-later
// Passes samples from the thread of an IMU to the thread of the scans.
#pragma once
#include <gst/gst.h>

#include <mutex>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/base/time.h"
#include "src/odometry/pose.h"

namespace lidar::gst {

/// The sample of an IMU in the sensor's frame.
struct MotionSample {
  Time time{};
  Eigen::Vector3d rate;   // [rad/s]
  Eigen::Vector3d force;  // [m/s^2]
};

/// The threads of the IMU and of the scans may use an object at the same time.
class ImuInput {
 public:
  /// Sets the layout of the samples that follow, and the rotation from the IMU to the sensor.
  /// Returns false if the layout is not that of ouster_src.
  bool SetCaps(const GstCaps* caps);
  /// Returns false if `samples` ends within a sample, or if there are no caps yet.
  bool Add(ByteView samples);
  /// Returns the samples since the last call.
  std::vector<MotionSample> Take();
  void Clear();

  static constexpr std::size_t kMostSamples = 8192;  // the oldest samples beyond it are dropped

 private:
  std::mutex mutex_;
  bool known_ = false;
  Eigen::Matrix3d to_sensor_ = Eigen::Matrix3d::Identity();
  std::vector<MotionSample> samples_;
};

}  // namespace lidar::gst
