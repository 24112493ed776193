// SPDX-License-Identifier: LGPL-2.1-or-later
// ROS 2 messages about motion, and the parts that all messages have.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "src/base/time.h"
#include "src/cdr/cdr_reader.h"
#include "src/cdr/cdr_writer.h"

namespace lidar::cdr {

using Vector3 = std::array<double, 3>;
using Quaternion = std::array<double, 4>;  // x, y, z, w

/// std_msgs/msg/Header. A stamp can have times from 1970 to 2038. WriteHeader() changes other times
/// to the nearer end of this range.
struct Header {
  Time stamp{};
  std::string frame_id;
};
Header ReadHeader(CdrReader* r);
void WriteHeader(const Header& header, CdrWriter* w);

/// sensor_msgs/msg/Imu. If the first number of a covariance is -1, the value was not measured.
struct Imu {
  Header header;
  Quaternion orientation = {0, 0, 0, 1};
  std::array<double, 9> orientation_covariance = {-1};
  Vector3 angular_velocity{};  // rad/s
  std::array<double, 9> angular_velocity_covariance{};
  Vector3 linear_acceleration{};  // m/s^2
  std::array<double, 9> linear_acceleration_covariance{};
};
std::optional<Imu> ReadImu(ByteView message);
std::vector<std::uint8_t> WriteImu(const Imu& imu);

/// nav_msgs/msg/Odometry: the pose of the frame child_frame_id in the frame header.frame_id.
struct Odometry {
  Header header;
  std::string child_frame_id;
  Vector3 position{};  // m
  Quaternion orientation = {0, 0, 0, 1};
  std::array<double, 36> pose_covariance{};
  Vector3 linear_velocity{};   // m/s
  Vector3 angular_velocity{};  // rad/s
  std::array<double, 36> twist_covariance{};
};
std::optional<Odometry> ReadOdometry(ByteView message);
std::vector<std::uint8_t> WriteOdometry(const Odometry& odometry);

/// geometry_msgs/msg/TransformStamped: transforms points from child_frame_id to header.frame_id.
struct TransformStamped {
  Header header;
  std::string child_frame_id;
  Vector3 translation{};  // m
  Quaternion rotation = {0, 0, 0, 1};
};
/// tf2_msgs/msg/TFMessage
using Transforms = std::vector<TransformStamped>;
std::optional<Transforms> ReadTransforms(ByteView message);
std::vector<std::uint8_t> WriteTransforms(const Transforms& transforms);

}  // namespace lidar::cdr
