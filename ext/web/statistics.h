// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes statistics of the elements of a pipeline as JSON.
#pragma once
#include <gst/gst.h>

#include <string>

namespace lidar::web {

/// Returns a message of the schema lidar.Statistics. It contains a timestamp, summaries, and the
/// property `stats` of each element in the pipeline of `element`. The `stats` of a bin replace the
/// `stats` of its children. Locks those elements for a moment.
std::string StatisticsOf(GstElement* element);

}  // namespace lidar::web
