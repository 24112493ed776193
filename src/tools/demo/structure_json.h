// SPDX-License-Identifier: LGPL-2.1-or-later
// Statistics structures of elements as JSON.
#pragma once
#include <gst/gst.h>

#include <nlohmann/json.hpp>

namespace lidar::demo {

/// Numbers, booleans, strings, enumerations (by nick), arrays and structures in structures; what
/// else there is comes as GStreamer prints it.
nlohmann::json ToJson(const GstStructure* structure);

/// The property `stats` of an element; null where there is none.
nlohmann::json StatsOf(GstElement* element);

}  // namespace lidar::demo
