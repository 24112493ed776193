// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs a pipeline until its end, an error, SIGINT or a duration; calls back once a second.
#pragma once
#include <gst/gst.h>

#include <functional>
#include <string>

#include "gst/common/refs.h"
#include "src/base/time.h"
#include "src/tools/common/elements.h"

namespace lidar::tools {

/// Throws std::runtime_error if the pads don't fit.
void LinkPads(GstElement* from, const char* from_pad, GstElement* to, const char* to_pad);

/// Returns 0, or 1 after an error. Prints the error with the prefix `program`. `end` makes the
/// source send EOS. The pipeline still plays on return.
int RunPipeline(GstElement* pipeline, const std::string& program, Duration duration,
                const std::function<void()>& every_100_ms, const std::function<void()>& end);

/// The Unix time now.
Duration UnixNow();

}  // namespace lidar::tools
