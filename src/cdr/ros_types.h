// SPDX-License-Identifier: LGPL-2.1-or-later
// The ROS 2 message types that we speak, by all the names that they have.
#pragma once
#include <array>
#include <string_view>

namespace lidar::cdr {

enum class RosType { kPointCloud2, kImu, kOdometry, kTransforms };

struct RosTypeInfo {
  RosType type;
  std::string_view name;      // as ROS tools show it
  std::string_view dds_name;  // of the topic's type in DDS
  std::string_view hash;      // REP 2016, version 1; from ROS 2 Iron on
};

constexpr std::array<RosTypeInfo, 4> kRosTypes = {{
    {RosType::kPointCloud2, "sensor_msgs/msg/PointCloud2", "sensor_msgs::msg::dds_::PointCloud2_",
     "RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5"},
    {RosType::kImu, "sensor_msgs/msg/Imu", "sensor_msgs::msg::dds_::Imu_",
     "RIHS01_7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b"},
    {RosType::kOdometry, "nav_msgs/msg/Odometry", "nav_msgs::msg::dds_::Odometry_",
     "RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0"},
    {RosType::kTransforms, "tf2_msgs/msg/TFMessage", "tf2_msgs::msg::dds_::TFMessage_",
     "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"},
}};

constexpr const RosTypeInfo& InfoOf(RosType type) {
  return kRosTypes[static_cast<std::size_t>(type)];
}

}  // namespace lidar::cdr
