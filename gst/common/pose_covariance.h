// SPDX-License-Identifier: LGPL-2.1-or-later
// Covariances of poses: as fields of structures, and those of nav_msgs/msg/Odometry, which also
// show whether a pose is tracked.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "gst/lidar/gstlidar.h"

namespace lidar::gst {

using Covariance = std::array<double, 36>;  // of x, y, z and the turns about them

/// A structure's field `covariance` has 36 doubles.
inline void SetCovariance(const double* covariance, GstStructure* s) {
  GValue numbers = G_VALUE_INIT;
  gst_value_array_init(&numbers, 36);
  GValue number = G_VALUE_INIT;
  g_value_init(&number, G_TYPE_DOUBLE);
  for (int i = 0; i < 36; ++i) {
    g_value_set_double(&number, covariance[i]);
    gst_value_array_append_value(&numbers, &number);
  }
  gst_structure_take_value(s, "covariance", &numbers);
}

/// Returns false if there is no such field.
inline bool GetCovariance(const GstStructure* s, double* covariance) {
  const GValue* numbers = gst_structure_get_value(s, "covariance");
  if (numbers == nullptr || !GST_VALUE_HOLDS_ARRAY(numbers) ||
      gst_value_array_get_size(numbers) != 36)
    return false;
  for (guint i = 0; i < 36; ++i) {
    const GValue* number = gst_value_array_get_value(numbers, i);
    if (!G_VALUE_HOLDS_DOUBLE(number)) return false;
    covariance[i] = g_value_get_double(number);
  }
  return true;
}

/// Variances so large that such a pose has no effect in a weighted mean [m^2, rad^2].
inline constexpr double kDegenerateVariance = 1e3;
inline constexpr double kUnknownVariance = 1e6;

inline void SetVariances(double position, double orientation, Covariance* covariance) {
  for (std::size_t i = 0; i < 6; ++i) (*covariance)[i * 7] = i < 3 ? position : orientation;
}

/// The covariance also carries the GstLidarTracking, for which ROS has no field. Zeros mean an
/// unknown covariance. `measured` is the covariance of a tracked pose.
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

/// Covariance of an unknown velocity, so that the velocity's zeros are not taken for a standstill.
inline Covariance NoVelocity() {
  Covariance covariance{};
  SetVariances(kUnknownVariance, kUnknownVariance, &covariance);
  return covariance;
}

}  // namespace lidar::gst
