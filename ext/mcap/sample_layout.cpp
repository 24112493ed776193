// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/mcap/sample_layout.h"

#include "src/cdr/motion_samples.h"

namespace lidar::gst {
namespace {

constexpr double kDegenerate = 1e3;  // m^2
constexpr double kLost = 1e6;

}  // namespace

bool IsOurImu(const GstCaps* caps) {
  const GstStructure* s = gst_caps_get_structure(caps, 0);
  gint size = 0;
  return gst_structure_get_int(s, "sample-size", &size) && size == gint{cdr::kImuSampleSize} &&
         g_strcmp0(gst_structure_get_string(s, "fields"), cdr::kImuFields) == 0;
}

void SetTracking(std::uint64_t tracking, cdr::Odometry* odometry) {
  if (tracking < GST_LIDAR_TRACKING_DEGENERATE) return;
  const double variance = tracking == GST_LIDAR_TRACKING_DEGENERATE ? kDegenerate : kLost;
  for (std::size_t i = 0; i < 6; ++i) odometry->pose_covariance[i * 7] = variance;
}

GstLidarTracking TrackingOf(const cdr::Odometry& odometry) {
  const double variance = odometry.pose_covariance[0];
  if (variance >= kLost) return GST_LIDAR_TRACKING_LOST;
  return variance >= kDegenerate ? GST_LIDAR_TRACKING_DEGENERATE : GST_LIDAR_TRACKING_OK;
}

}  // namespace lidar::gst
