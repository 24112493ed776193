// SPDX-License-Identifier: LGPL-2.1-or-later
// The pads of lidarodometry for other data than clouds: poses, the frame of the map, and an IMU.
#pragma once
#include <gst/gst.h>

#include "ext/odometry/imu_input.h"
#include "src/odometry/odometry.h"

namespace lidar::gst {

/// Adds the requested pad, `map` or `imu`. Returns null if the element has this pad already.
/// Samples from the pad `imu` are added to the object `imu`, which must outlive the pad.
GstPad* AddSidePad(GstElement* element, GstPadTemplate* pad_template, ImuInput* imu);

/// These functions push a buffer if their pad exists and is linked.
void PushPose(GstElement* element, const odometry::Estimate& estimate, GstClockTime pts);
void PushMap(GstElement* element, const odometry::Pose& map_from_odometry, Time time,
             GstClockTime pts);
/// Pushes an event from the stream of clouds to the pads odometry and map. A STREAM_START event is
/// followed by the caps of the pad.
void PushToPoses(GstElement* element, GstEvent* event);

}  // namespace lidar::gst
