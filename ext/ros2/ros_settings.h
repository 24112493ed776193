// SPDX-License-Identifier: LGPL-2.1-or-later
// The properties that the ROS 2 elements have in common, and how they become the options of an
// endpoint.
#pragma once
#include <gst/gst.h>

#include <optional>
#include <string>

#include "ext/ros2/endpoint.h"
#include "gst/common/properties.h"

namespace lidar::gst {

enum class RosQos : gint { kSensorData, kReliable };
enum class RosDistro : gint { kHumble, kIron, kJazzy, kKilted, kRolling };

struct RosSettings {
  std::string topic = "/points";
  gint domain_id = -1;  // -1: from the environment
  std::string node_name;
  RosQos qos = RosQos::kSensorData;
  guint depth = 5;
  RosDistro distro = RosDistro::kJazzy;
};

GType RosQosType();
GType RosDistroType();
const std::array<Property<RosSettings>, 6>& RosRows();

/// Returns the options of an endpoint. If a setting is wrong, posts an error message that names the
/// setting and returns nothing.
std::optional<dds::EndpointOptions> ToOptions(GstElement* element, const RosSettings& settings,
                                              cdr::RosType type);

}  // namespace lidar::gst
