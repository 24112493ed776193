// SPDX-License-Identifier: LGPL-2.1-or-later
// The caps of samples of an inertial measurement unit.
#pragma once
#include <gst/gst.h>

#include <array>

#include "gst/common/caps_text.h"
#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "src/base/imu_sample.h"

namespace lidar::gst {

/// Returns the caps of samples with the fields kImuFields.
inline CapsPtr ImuCaps() {
  return CapsPtr(gst_caps_new_simple(GST_LIDAR_IMU_MEDIA_TYPE, "sample-size", G_TYPE_INT,
                                     static_cast<gint>(kImuSampleSize), "fields", G_TYPE_STRING,
                                     kImuFields, nullptr));
}

using ImuToSensor = std::array<double, 16>;  // row-major, translation in metres
inline CapsPtr ImuCaps(const ImuToSensor& imu_to_sensor) {
  CapsPtr caps = ImuCaps();
  caps_text::SetDoubles(gst_caps_get_structure(caps.get(), 0), "imu-to-sensor",
                        {imu_to_sensor.begin(), imu_to_sensor.end()});
  return caps;
}

}  // namespace lidar::gst
