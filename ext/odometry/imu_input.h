// SPDX-License-Identifier: LGPL-2.1-or-later
// Passes samples of an IMU from the thread that receives them to the thread that aligns scans.
#pragma once
#include <gst/gst.h>

#include <mutex>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/base/time.h"
#include "src/odometry/pose.h"

namespace lidar::gst {

/// A sample of an IMU in the sensor's frame.
struct MotionSample {
  Time time{};
  Eigen::Vector3d rate;   // [rad/s]
  Eigen::Vector3d force;  // [m/s^2]
};

/// A queue of samples. The thread of the IMU and the thread of the scans may use it at the same
/// time.
class ImuInput {
 public:
  /// Sets the layout of later samples, and the rotation from the IMU to the sensor. Returns false
  /// if the layout differs from that of ouster_src.
  bool SetCaps(const GstCaps* caps);
  /// Adds samples. Returns false if `samples` does not end at the end of a sample, or if SetCaps()
  /// has not succeeded yet.
  bool Add(ByteView samples);
  /// Returns and removes all samples that were added since the last call.
  std::vector<MotionSample> Take();
  void Clear();

  static constexpr std::size_t kMostSamples = 8192;  // if there are more, the oldest are dropped

 private:
  std::mutex mutex_;
  bool known_ = false;
  Eigen::Matrix3d to_sensor_ = Eigen::Matrix3d::Identity();
  std::vector<MotionSample> samples_;
};

}  // namespace lidar::gst
