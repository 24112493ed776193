// SPDX-License-Identifier: LGPL-2.1-or-later
// The pads of lidarodometry that are not for clouds: poses, the map's frame, and an IMU.
#pragma once
#include <gst/gst.h>

#include "ext/odometry/imu_input.h"
#include "src/odometry/odometry.h"

namespace lidar::gst {

/// Adds a pad on request, `map` or `imu`. Returns null if the element has it already. `imu` takes
/// the samples, and must outlive the pad.
GstPad* AddSidePad(GstElement* element, GstPadTemplate* pad_template, ImuInput* imu);

/// These functions push only if their pad is linked.
void PushPose(GstElement* element, const odometry::Estimate& estimate, GstClockTime pts);
void PushMap(GstElement* element, const odometry::Pose& map_from_odometry, Time time,
             GstClockTime pts);
/// Pushes an event of the clouds to the pads of poses that exist. Each pad's own caps follow the
/// start of the stream.
void PushToPoses(GstElement* element, GstEvent* event);

}  // namespace lidar::gst
