// SPDX-License-Identifier: LGPL-2.1-or-later
// Which samples of an IMU can be recorded.
#pragma once
#include <gst/gst.h>

namespace lidar::gst {

bool IsOurImu(const GstCaps* caps);

}  // namespace lidar::gst
