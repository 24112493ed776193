// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cdr/motion_samples.h"

#include <algorithm>

#include "src/base/byte_writer.h"
#include "src/base/pose_bytes.h"

namespace lidar::cdr {

std::vector<std::uint8_t> WriteImuSample(const Imu& imu) {
  std::vector<std::uint8_t> bytes;
  lidar::WriteImuSample({imu.header.stamp, imu.linear_acceleration, imu.angular_velocity}, &bytes);
  return bytes;
}

std::vector<Imu> ReadImuSamples(ByteView bytes) {
  std::vector<Imu> samples;
  if (bytes.size % kImuSampleSize != 0) return samples;
  ByteReader r(bytes);
  while (r.remaining() > 0) {
    Imu& imu = samples.emplace_back();
    const auto ns = std::min<std::uint64_t>(r.Le64(), INT64_MAX);
    imu.header.stamp += Duration{static_cast<std::int64_t>(ns)};
    for (double& v : imu.linear_acceleration) v = double{r.LeF32()};
    for (double& v : imu.angular_velocity) v = double{r.LeF32()};
  }
  return samples;
}

std::vector<std::uint8_t> WritePose(const Odometry& odometry, std::uint64_t tracking) {
  std::vector<std::uint8_t> bytes;
  ByteWriter w(&bytes);
  for (const double v : odometry.position) w.LeF64(v);
  for (const double v : odometry.orientation) w.LeF64(v);
  w.Le64(tracking);
  const auto& covariance = odometry.pose_covariance;
  if (std::any_of(covariance.begin(), covariance.end(), [](double v) { return v != 0; }))
    for (const double v : covariance) w.LeF64(v);
  return bytes;
}

std::optional<Odometry> ReadPose(ByteView bytes, std::uint64_t* tracking) {
  if (bytes.size != kPoseSize && bytes.size != kPoseSizeWithCovariance) return std::nullopt;
  ByteReader r(bytes);
  Odometry odometry;
  for (double& v : odometry.position) v = r.LeF64();
  for (double& v : odometry.orientation) v = r.LeF64();
  *tracking = r.Le64();
  if (r.remaining() > 0)
    for (double& v : odometry.pose_covariance) v = r.LeF64();
  return odometry;
}

}  // namespace lidar::cdr
