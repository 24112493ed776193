// SPDX-License-Identifier: LGPL-2.1-or-later
// Covariances of nav_msgs/msg/Odometry, which also show whether a pose is tracked.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "gst/lidar/gstlidar.h"

namespace lidar::gst {

using Covariance = std::array<double, 36>;  // of x, y, z and the turns about them

/// Variances with which a weighted pose has no effect [m^2, rad^2].
inline constexpr double kDegenerateVariance = 1e3;
inline constexpr double kUnknownVariance = 1e6;

inline void SetVariances(double position, double orientation, Covariance* covariance) {
  for (std::size_t i = 0; i < 6; ++i) (*covariance)[i * 7] = i < 3 ? position : orientation;
}

/// The covariance also carries the GstLidarTracking, for which ROS has no field. Zeros mean an
/// unknown covariance. `measured` is that of a tracked pose.
inline Covariance CovarianceOf(std::uint64_t tracking, const Covariance& measured = {}) {
  Covariance covariance{};
  if (tracking <= GST_LIDAR_TRACKING_OK) return measured;
  if (tracking == GST_LIDAR_TRACKING_DEGENERATE)
    SetVariances(kDegenerateVariance, kDegenerateVariance, &covariance);
  if (tracking >= GST_LIDAR_TRACKING_LOST)
    SetVariances(kUnknownVariance, kUnknownVariance, &covariance);
  return covariance;
}

inline GstLidarTracking TrackingOf(const Covariance& covariance) {
  if (covariance[0] >= kUnknownVariance) return GST_LIDAR_TRACKING_LOST;
  return covariance[0] >= kDegenerateVariance ? GST_LIDAR_TRACKING_DEGENERATE
                                              : GST_LIDAR_TRACKING_OK;
}

/// Covariance of an unknown velocity, so that its zeros are not taken for a standstill.
inline Covariance NoVelocity() {
  Covariance covariance{};
  SetVariances(kUnknownVariance, kUnknownVariance, &covariance);
  return covariance;
}

}  // namespace lidar::gst
