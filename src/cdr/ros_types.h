// SPDX-License-Identifier: LGPL-2.1-or-later
// The ROS 2 message types that we support, with all their names.
#pragma once
#include <array>
#include <string_view>

namespace lidar::cdr {

enum class RosType { kPointCloud2, kImu, kOdometry, kTransforms, kLivox, kCompressedCloud };

struct RosTypeInfo {
  RosType type;
  std::string_view name;      // as ROS tools show it
  std::string_view dds_name;  // name of the topic's type in DDS
  std::string_view hash;      // REP 2016, version 1; from ROS 2 Iron on
};

constexpr std::array<RosTypeInfo, 6> kRosTypes = {{
    {RosType::kPointCloud2, "sensor_msgs/msg/PointCloud2", "sensor_msgs::msg::dds_::PointCloud2_",
     "RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5"},
    {RosType::kImu, "sensor_msgs/msg/Imu", "sensor_msgs::msg::dds_::Imu_",
     "RIHS01_7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b"},
    {RosType::kOdometry, "nav_msgs/msg/Odometry", "nav_msgs::msg::dds_::Odometry_",
     "RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0"},
    {RosType::kTransforms, "tf2_msgs/msg/TFMessage", "tf2_msgs::msg::dds_::TFMessage_",
     "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"},
    {RosType::kLivox, "livox_ros_driver2/msg/CustomMsg", "livox_ros_driver2::msg::dds_::CustomMsg_",
     "RIHS01_2eb17e5e35bf5a2d6cd079f3c57f33abf95e5bf7d71b42cddc05daace73d815a"},
    {RosType::kCompressedCloud, "point_cloud_interfaces/msg/CompressedPointCloud2",
     "point_cloud_interfaces::msg::dds_::CompressedPointCloud2_",
     "RIHS01_4b38df4932a156a54c53e80a7f34e54e2966b20e54a4d14ded34a165a389c0c1"},
}};

/// Returns true if messages of this type contain points.
constexpr bool IsCloud(RosType type) {
  return type == RosType::kPointCloud2 || type == RosType::kLivox ||
         type == RosType::kCompressedCloud;
}

constexpr const RosTypeInfo& InfoOf(RosType type) {
  return kRosTypes[static_cast<std::size_t>(type)];
}

}  // namespace lidar::cdr
