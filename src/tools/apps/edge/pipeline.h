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

/// Adds a recorder to the pipeline, and sets it to the state of the pipeline. Errors of the
/// recorder appear on the bus of the pipeline, but do not stop the stream. Throws
/// std::runtime_error if an element is missing.
void AddRecorder(GstElement* pipeline, const RobotConfig& robot);
/// Removes the recorder if there is one.
void RemoveRecorder(GstElement* pipeline);
/// Returns true if the message comes from the recorder.
bool IsFromRecorder(GstMessage* message);

/// Ends the stream, and waits until all received data are written and sent. Calls
/// `on_recorder_error` for an error of the recorder. This function must then remove the recorder,
/// and the other branches continue. Returns false after any other error, or when `timeout` has
/// passed.
bool Drain(GstElement* pipeline, GstClockTime timeout,
           const std::function<void(GstMessage*)>& on_recorder_error);

}  // namespace lidar::edge
