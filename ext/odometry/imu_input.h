// SPDX-License-Identifier: LGPL-2.1-or-later
// Angular velocities between the thread of an IMU and that of the scans.
#pragma once
#include <gst/gst.h>

#include <mutex>
#include <vector>

#include "src/base/byte_reader.h"
#include "src/base/time.h"
#include "src/odometry/pose.h"

namespace lidar::gst {

struct TurnSample {
  Time time{};
  Eigen::Vector3d rate;  // in the sensor's frame [rad/s]
};

/// Safe for the threads of both streams.
class ImuInput {
 public:
  /// The layout of the samples that follow, and how the IMU stands in the sensor. Returns false if
  /// they are not laid out as ouster_src has them.
  bool SetCaps(const GstCaps* caps);
  /// Returns false if the bytes are no whole samples, or there are no caps yet.
  bool Add(ByteView samples);
  /// The samples since the last call.
  std::vector<TurnSample> Take();
  void Clear();

  static constexpr std::size_t kMostSamples = 8192;  // samples that wait; older ones are dropped

 private:
  std::mutex mutex_;
  bool known_ = false;
  Eigen::Matrix3d to_sensor_ = Eigen::Matrix3d::Identity();
  std::vector<TurnSample> samples_;
};

}  // namespace lidar::gst
