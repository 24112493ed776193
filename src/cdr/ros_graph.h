// SPDX-License-Identifier: LGPL-2.1-or-later
// How ROS 2 announces nodes, and the names of its topics in DDS.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lidar::cdr {

/// The topic on which each participant announces its nodes. Its QoS is reliable and
/// transient-local.
inline constexpr const char* kGraphTopic = "ros_discovery_info";
inline constexpr const char* kGraphDdsName = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";

using Guid = std::array<std::uint8_t, 16>;

struct NodeName {
  std::string name_space = "/";
  std::string name;
};
/// Parses "lidar", "/robot/lidar" or "robot/lidar". Returns nothing if ROS would refuse the name.
std::optional<NodeName> ParseNodeName(std::string_view text);
/// Converts any text to a valid last part of a node's name.
std::string ToNodeName(std::string_view text);
/// Converts "/ouster/points" or "points" to the name of the topic in DDS, which begins with rt/.
/// Returns nothing if ROS would refuse the name.
std::optional<std::string> ToDdsTopic(std::string_view ros_topic);

/// rmw_dds_common/msg/ParticipantEntitiesInfo for a participant with one node. A Gid has `gid_size`
/// bytes: 24 up to ROS 2 Humble, and 16 in later versions.
struct ParticipantEntities {
  Guid participant{};
  NodeName node;
  std::vector<Guid> readers;
  std::vector<Guid> writers;
};
std::vector<std::uint8_t> WriteParticipantEntities(const ParticipantEntities& entities,
                                                   std::size_t gid_size);

}  // namespace lidar::cdr
