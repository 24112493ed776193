// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs a pipeline until EOS, an error, a signal or the end of a duration. Calls a function every
// 100 ms while the pipeline plays.
#pragma once
#include <gst/gst.h>

#include <functional>
#include <string>

#include "gst/common/refs.h"
#include "src/base/time.h"
#include "src/tools/common/elements.h"

namespace lidar::tools {

/// Links two pads. Throws std::runtime_error if they cannot be linked.
void LinkPads(GstElement* from, const char* from_pad, GstElement* to, const char* to_pad);

/// Runs a pipeline. Returns 0, or 1 after an error, which is printed after the prefix `program`.
/// `duration` counts from the first call of `every_100_ms`, not from the start of the pipeline.
/// `end` must make the source send EOS. The pipeline is still playing when this function returns.
int RunPipeline(GstElement* pipeline, const std::string& program, Duration duration,
                const std::function<void()>& every_100_ms, const std::function<void()>& end);

Duration UnixNow();

}  // namespace lidar::tools
