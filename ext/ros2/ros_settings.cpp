// SPDX-License-Identifier: LGPL-2.1-or-later
#include "ext/ros2/ros_settings.h"

#include <cstdlib>

#include "gst/common/enum_type.h"
#include "gst/common/refs.h"

namespace lidar::gst {
namespace {

constexpr gint kMaxDomain = 232;  // highest number that has ports

/// Returns the domain in the environment, or 0 if none is set. Returns nothing if it is not a valid
/// number.
std::optional<gint> DomainOfEnvironment() {
  const char* text = std::getenv("ROS_DOMAIN_ID");
  if (text == nullptr || *text == '\0') return 0;
  gchar* end = nullptr;
  const gint64 value = g_ascii_strtoll(text, &end, 10);
  if (*end != '\0' || value < 0 || value > kMaxDomain) return std::nullopt;
  return static_cast<gint>(value);
}

}  // namespace

GType RosQosType() {
  static const GEnumValue kValues[] = {
      {Int(RosQos::kSensorData), "Best effort: the newest, none twice", "sensor-data"},
      {Int(RosQos::kReliable), "Reliable: what was lost comes again", "reliable"},
      {0, nullptr, nullptr}};
  static const GType type = RegisterEnum("GstLidarRosQos", kValues);
  return type;
}

GType RosDistroType() {
  static const GEnumValue kValues[] = {{Int(RosDistro::kHumble), "Humble Hawksbill", "humble"},
                                       {Int(RosDistro::kIron), "Iron Irwini", "iron"},
                                       {Int(RosDistro::kJazzy), "Jazzy Jalisco", "jazzy"},
                                       {Int(RosDistro::kKilted), "Kilted Kaiju", "kilted"},
                                       {Int(RosDistro::kRolling), "Rolling Ridley", "rolling"},
                                       {0, nullptr, nullptr}};
  static const GType type = RegisterEnum("GstLidarRosDistro", kValues);
  return type;
}

const std::array<Property<RosSettings>, 6>& RosRows() {
  static const std::array<Property<RosSettings>, 6> kRows = {{
      {"topic", "Name of the ROS 2 topic", &RosSettings::topic},
      {"domain-id", "DDS domain; -1: the variable ROS_DOMAIN_ID, or 0", &RosSettings::domain_id, -1,
       kMaxDomain},
      {"node-name", "Name of the node, with its namespace if it has one; NULL: the element's name",
       &RosSettings::node_name},
      {"qos", "Reliability of DDS: whether lost messages are sent again",
       EnumField<RosSettings, RosQos>{&RosSettings::qos, RosQosType}},
      {"depth", "Depth of the history of DDS: messages that wait to be taken [messages]",
       &RosSettings::depth, 1, 1000},
      {"ros-distro", "ROS 2 distribution of the peers, whose tools show nodes and types",
       EnumField<RosSettings, RosDistro>{&RosSettings::distro, RosDistroType}},
  }};
  return kRows;
}

std::optional<dds::EndpointOptions> ToOptions(GstElement* element, const RosSettings& settings,
                                              cdr::RosType type) {
  const StringPtr name(gst_element_get_name(element));
  const auto node = cdr::ParseNodeName(settings.node_name.empty() ? cdr::ToNodeName(name.get())
                                                                  : settings.node_name);
  const auto topic = cdr::ToDdsTopic(settings.topic);
  const auto domain =
      settings.domain_id >= 0 ? std::optional(settings.domain_id) : DomainOfEnvironment();
  if (!node || !topic) {
    GST_ELEMENT_ERROR(element, RESOURCE, SETTINGS,
                      ("The %s \"%s\" is not valid in ROS 2: it must be words of letters, digits "
                       "and underscores, with single slashes between them.",
                       topic ? "node-name" : "topic",
                       topic ? settings.node_name.c_str() : settings.topic.c_str()),
                      (nullptr));
    return std::nullopt;
  }
  if (!domain) {
    GST_ELEMENT_ERROR(element, RESOURCE, SETTINGS,
                      ("The variable ROS_DOMAIN_ID must be a number from 0 to %d.", kMaxDomain),
                      (nullptr));
    return std::nullopt;
  }
  dds::EndpointOptions options;
  options.domain = static_cast<std::uint32_t>(*domain);
  options.node = *node;
  options.topic = *topic;
  options.type = type;
  options.reliable = settings.qos == RosQos::kReliable;
  options.depth = settings.depth;
  options.gid_size = settings.distro == RosDistro::kHumble ? 24 : 16;
  options.tells_type_hash = settings.distro != RosDistro::kHumble;
  return options;
}

}  // namespace lidar::gst
