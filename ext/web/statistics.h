// SPDX-License-Identifier: LGPL-2.1-or-later
// What the elements of a pipeline tell of themselves, as JSON.
#pragma once
#include <gst/gst.h>

#include <string>

namespace lidar::web {

/// A message of the schema lidar.Statistics: the property `stats` of each element of the pipeline
/// that `element` is in. A bin that has one speaks for its children. Takes the locks of those
/// elements for a moment.
std::string StatisticsOf(GstElement* element);

}  // namespace lidar::web
