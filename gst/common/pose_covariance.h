// SPDX-License-Identifier: LGPL-2.1-or-later
// Covariances of poses, as fields of structures and as in nav_msgs/msg/Odometry. In the latter they
// also show whether a pose is tracked.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "gst/lidar/gstlidar.h"

namespace lidar::gst {

using Covariance = std::array<double, 36>;  // of x, y, z and the rotations about these axes

/// Sets the field `covariance` of a structure to 36 doubles.
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

/// Reads the field `covariance`. Returns false if it is missing or is not 36 doubles.
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

/// Variances of poses that are not tracked [m^2, rad^2]. They are so large that these poses have no
/// effect in a weighted mean.
inline constexpr double kDegenerateVariance = 1e3;
inline constexpr double kUnknownVariance = 1e6;

inline void SetVariances(double position, double orientation, Covariance* covariance) {
  for (std::size_t i = 0; i < 6; ++i) (*covariance)[i * 7] = i < 3 ? position : orientation;
}

/// Returns the covariance for a pose with the state `tracking`. ROS has no field for this state, so
/// it is encoded in the covariance. `measured` is the covariance of a tracked pose; zeros mean that
/// it is not known.
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

/// Returns the covariance of a velocity that is not known. Otherwise the zeros of this velocity
/// would mean that the sensor does not move.
inline Covariance NoVelocity() {
  Covariance covariance{};
  SetVariances(kUnknownVariance, kUnknownVariance, &covariance);
  return covariance;
}

}  // namespace lidar::gst
