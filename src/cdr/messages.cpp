// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cdr/messages.h"

#include <algorithm>

namespace lidar::cdr {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;
// The size of a stamp, two empty texts and seven numbers, without padding.
constexpr std::size_t kSmallestTransform = 72;

}  // namespace

Header ReadHeader(CdrReader* r) {
  Header header;
  const std::int64_t seconds = r->I32();
  header.stamp += Duration{seconds * kNsPerSecond + r->U32()};
  header.frame_id = r->Text();
  return header;
}

void WriteHeader(const Header& header, CdrWriter* w) {
  constexpr std::int64_t kEnd = (std::int64_t{1} << 31) * kNsPerSecond - 1;
  const auto ns = std::clamp<std::int64_t>(header.stamp.time_since_epoch().count(), 0, kEnd);
  w->I32(static_cast<std::int32_t>(ns / kNsPerSecond));
  w->U32(static_cast<std::uint32_t>(ns % kNsPerSecond));
  w->Text(header.frame_id);
}

std::optional<Imu> ReadImu(ByteView message) {
  CdrReader r(message);
  Imu imu;
  imu.header = ReadHeader(&r);
  r.F64s(&imu.orientation);
  r.F64s(&imu.orientation_covariance);
  r.F64s(&imu.angular_velocity);
  r.F64s(&imu.angular_velocity_covariance);
  r.F64s(&imu.linear_acceleration);
  r.F64s(&imu.linear_acceleration_covariance);
  if (!r.ok()) return std::nullopt;
  return imu;
}

std::vector<std::uint8_t> WriteImu(const Imu& imu) {
  std::vector<std::uint8_t> out;
  CdrWriter w(&out);
  WriteHeader(imu.header, &w);
  w.F64s(imu.orientation);
  w.F64s(imu.orientation_covariance);
  w.F64s(imu.angular_velocity);
  w.F64s(imu.angular_velocity_covariance);
  w.F64s(imu.linear_acceleration);
  w.F64s(imu.linear_acceleration_covariance);
  return out;
}

std::optional<Odometry> ReadOdometry(ByteView message) {
  CdrReader r(message);
  Odometry odometry;
  odometry.header = ReadHeader(&r);
  odometry.child_frame_id = r.Text();
  r.F64s(&odometry.position);
  r.F64s(&odometry.orientation);
  r.F64s(&odometry.pose_covariance);
  r.F64s(&odometry.linear_velocity);
  r.F64s(&odometry.angular_velocity);
  r.F64s(&odometry.twist_covariance);
  if (!r.ok()) return std::nullopt;
  return odometry;
}

std::vector<std::uint8_t> WriteOdometry(const Odometry& odometry) {
  std::vector<std::uint8_t> out;
  CdrWriter w(&out);
  WriteHeader(odometry.header, &w);
  w.Text(odometry.child_frame_id);
  w.F64s(odometry.position);
  w.F64s(odometry.orientation);
  w.F64s(odometry.pose_covariance);
  w.F64s(odometry.linear_velocity);
  w.F64s(odometry.angular_velocity);
  w.F64s(odometry.twist_covariance);
  return out;
}

std::optional<Transforms> ReadTransforms(ByteView message) {
  CdrReader r(message);
  Transforms transforms(r.Count(kSmallestTransform));
  for (TransformStamped& t : transforms) {
    t.header = ReadHeader(&r);
    t.child_frame_id = r.Text();
    r.F64s(&t.translation);
    r.F64s(&t.rotation);
    if (!r.ok()) break;
  }
  if (!r.ok()) return std::nullopt;
  return transforms;
}

std::vector<std::uint8_t> WriteTransforms(const Transforms& transforms) {
  std::vector<std::uint8_t> out;
  CdrWriter w(&out);
  w.U32(static_cast<std::uint32_t>(transforms.size()));
  for (const TransformStamped& t : transforms) {
    WriteHeader(t.header, &w);
    w.Text(t.child_frame_id);
    w.F64s(t.translation);
    w.F64s(t.rotation);
  }
  return out;
}

}  // namespace lidar::cdr
