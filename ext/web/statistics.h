// SPDX-License-Identifier: LGPL-2.1-or-later
// Statistics of the elements of a pipeline, as JSON.
#pragma once
#include <gst/gst.h>

#include <string>

namespace lidar::web {

/// A message of the schema lidar.Statistics: a timestamp, summaries, and the property `stats` of
/// each element of the pipeline that `element` is in. The `stats` of a bin replace those of its
/// children. Takes the locks of those elements for a moment.
std::string StatisticsOf(GstElement* element);

}  // namespace lidar::web
