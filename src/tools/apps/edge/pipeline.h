// SPDX-License-Identifier: LGPL-2.1-or-later
// The pipeline of one robot, and the branch that records it, which comes and goes by itself.
#pragma once
#include <gio/gio.h>
#include <gst/gst.h>

#include <functional>

#include "gst/common/refs.h"
#include "src/tools/apps/edge/edge_config.h"

namespace lidar::edge {

/// Receives, and hands on to NATS; `socket` is the robot's on the port for all, or NULL. Throws
/// std::runtime_error if an element is missing.
gst::ElementPtr MakePipeline(const EdgeConfig& config, const RobotConfig& robot, GSocket* socket);

/// Makes a recorder that runs with the pipeline. Its failures stay in it, and go to the bus. Throws
/// std::runtime_error if an element is missing.
void AddRecorder(GstElement* pipeline, const RobotConfig& robot);
/// Does nothing if there is none.
void RemoveRecorder(GstElement* pipeline);
/// Whether the message is of the recorder.
bool IsFromRecorder(GstMessage* message);

/// Ends the stream, and waits until all that has come is written and sent. Errors of the recorder
/// go to `on_recorder_error`, which removes it, and what is left goes on. False at another error,
/// or where it takes longer than `timeout`.
bool Drain(GstElement* pipeline, GstClockTime timeout,
           const std::function<void(GstMessage*)>& on_recorder_error);

}  // namespace lidar::edge
