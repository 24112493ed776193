// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/odometry/pose_output.h"

#include <algorithm>
#include <cmath>

#include "gst/common/coordinate_frames.h"
#include "src/base/pose_bytes.h"
#include "src/cdr/motion_samples.h"

namespace lidar::gst {
namespace {

using odometry::Estimate;
using odometry::Pose;

GstStructure* PoseMessage(const char* name, const Pose& pose) {
  const auto& p = pose.position;
  const auto& q = pose.rotation;
  return gst_structure_new(name, "x", G_TYPE_DOUBLE, p.x(), "y", G_TYPE_DOUBLE, p.y(), "z",
                           G_TYPE_DOUBLE, p.z(), "qx", G_TYPE_DOUBLE, q.x(), "qy", G_TYPE_DOUBLE,
                           q.y(), "qz", G_TYPE_DOUBLE, q.z(), "qw", G_TYPE_DOUBLE, q.w(), nullptr);
}

cdr::Odometry ToOdometry(const Pose& pose) {
  cdr::Odometry told;
  std::copy_n(pose.position.data(), 3, told.position.begin());
  std::copy_n(pose.rotation.coeffs().data(), 4, told.orientation.begin());
  return told;
}

GstBuffer* ToBuffer(const std::vector<std::uint8_t>& bytes, Time time, GstClockTime pts) {
  GstBuffer* buffer = gst_buffer_new_memdup(bytes.data(), bytes.size());
  GST_BUFFER_PTS(buffer) = pts;
  gst_lidar_buffer_set_capture_time(buffer,
                                    static_cast<GstClockTime>(time.time_since_epoch().count()));
  return buffer;
}

}  // namespace

Covariance CovarianceOf(const Estimate& e) {
  Covariance rows;
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(rows.data()) = e.covariance;
  return rows;
}

double PositionDeviation(const Estimate& e) {
  return std::sqrt(e.covariance.topLeftCorner<3, 3>().trace());
}

double OrientationDeviation(const Estimate& e) {
  return std::sqrt(e.covariance.bottomRightCorner<3, 3>().trace());
}

GstLidarPose ToMeta(const Pose& pose, const Estimate& last) {
  const auto& p = pose.position;
  const auto& q = pose.rotation;
  GstLidarPose meta{{p.x(), p.y(), p.z()},
                    {q.x(), q.y(), q.z(), q.w()},
                    static_cast<GstLidarTracking>(last.tracking),
                    {}};
  const Covariance covariance = CovarianceOf(last);
  std::copy(covariance.begin(), covariance.end(), meta.covariance);
  return meta;
}

GstStructure* OdometryMessage(const Estimate& e) {
  GstStructure* told = PoseMessage("odometry", e.pose);
  gst_structure_set(told, "timestamp", G_TYPE_UINT64,
                    static_cast<guint64>(e.time.time_since_epoch().count()), "tracking",
                    G_TYPE_STRING, ToString(e.tracking), "inlier-share", G_TYPE_DOUBLE,
                    e.inlier_share, nullptr);
  SetCovariance(CovarianceOf(e).data(), told);
  return told;
}

GstStructure* LoopMessage(const Pose& map_from_odometry, std::size_t loops) {
  GstStructure* told = PoseMessage("loop-closed", map_from_odometry);
  gst_structure_set(told, "loops", G_TYPE_UINT64, static_cast<guint64>(loops), nullptr);
  return told;
}

GstBuffer* PoseBuffer(const Estimate& e, GstClockTime pts) {
  cdr::Odometry told = ToOdometry(e.pose);
  told.pose_covariance = CovarianceOf(e);
  auto bytes = cdr::WritePose(told, static_cast<std::uint64_t>(e.tracking));
  // WritePose() omits a covariance of 0, which the first scan has. So the zeros are added here.
  bytes.resize(kPoseSizeWithCovariance);
  return ToBuffer(bytes, e.time, pts);
}

GstBuffer* MapBuffer(const Pose& map_from_odometry, Time time, GstClockTime pts) {
  return ToBuffer(cdr::WritePose(ToOdometry(map_from_odometry), GST_LIDAR_TRACKING_OK), time, pts);
}

CapsPtr MapCaps() {
  return CapsPtr(gst_caps_new_simple(GST_LIDAR_ODOMETRY_MEDIA_TYPE, GST_LIDAR_FRAME_ID,
                                     G_TYPE_STRING, kMapFrame, GST_LIDAR_CHILD_FRAME_ID,
                                     G_TYPE_STRING, kOdometryFrame, nullptr));
}

}  // namespace lidar::gst
