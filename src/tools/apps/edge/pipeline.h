// SPDX-License-Identifier: LGPL-2.1-or-later
// The pipeline of a robot. Its recording branch can be added and removed while the pipeline runs.
#pragma once
#include <gio/gio.h>
#include <gst/gst.h>

#include <functional>

#include "gst/common/refs.h"
#include "src/tools/apps/edge/edge_config.h"

namespace lidar::edge {

/// Makes a pipeline that receives from the robot and publishes to NATS. `socket` is the robot's
/// socket on the common port, or NULL. Throws std::runtime_error if an element is missing.
gst::ElementPtr MakePipeline(const EdgeConfig& config, const RobotConfig& robot, GSocket* socket);

/// Adds a recorder in the pipeline's state. Its errors appear on the bus, and do not stop the
/// stream. Throws std::runtime_error if an element is missing.
void AddRecorder(GstElement* pipeline, const RobotConfig& robot);
/// Does nothing without a recorder.
void RemoveRecorder(GstElement* pipeline);
/// Whether the message comes from the recorder.
bool IsFromRecorder(GstMessage* message);

/// Ends the stream, and waits until all received data are written and sent. Errors of the recorder
/// go to `on_recorder_error`, which removes it; the other branches continue. Returns false after
/// another error or `timeout`.
bool Drain(GstElement* pipeline, GstClockTime timeout,
           const std::function<void(GstMessage*)>& on_recorder_error);

}  // namespace lidar::edge
