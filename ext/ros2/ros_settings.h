// SPDX-License-Identifier: LGPL-2.1-or-later
// The common part of ROS 2's elements: their properties, and how they open their endpoint.
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
  gint domain_id = -1;  // -1: the environment's
  std::string node_name;
  RosQos qos = RosQos::kSensorData;
  guint depth = 5;
  RosDistro distro = RosDistro::kJazzy;
};

GType RosQosType();
GType RosDistroType();
const std::array<Property<RosSettings>, 6>& RosRows();

/// Returns nothing after an error message that names the setting that is wrong.
std::optional<dds::EndpointOptions> ToOptions(GstElement* element, const RosSettings& settings,
                                              cdr::RosType type);

}  // namespace lidar::gst
