// SPDX-License-Identifier: LGPL-2.1-or-later
// Caps of the samples of an inertial measurement unit.
#pragma once
#include <gst/gst.h>

#include <array>

#include "gst/common/refs.h"
#include "gst/lidar/gstlidar.h"
#include "src/base/imu_sample.h"

namespace lidar::gst {

/// Caps of samples as kImuFields has them.
inline CapsPtr ImuCaps() {
  return CapsPtr(gst_caps_new_simple(GST_LIDAR_IMU_MEDIA_TYPE, "sample-size", G_TYPE_INT,
                                     static_cast<gint>(kImuSampleSize), "fields", G_TYPE_STRING,
                                     kImuFields, nullptr));
}

using ImuToSensor = std::array<double, 16>;  // row-major [m]
inline CapsPtr ImuCaps(const ImuToSensor& imu_to_sensor) {
  CapsPtr caps = ImuCaps();
  GValue list = G_VALUE_INIT;
  gst_value_array_init(&list, 16);
  for (const double v : imu_to_sensor) {
    GValue value = G_VALUE_INIT;
    g_value_init(&value, G_TYPE_DOUBLE);
    g_value_set_double(&value, v);
    gst_value_array_append_and_take_value(&list, &value);
  }
  gst_caps_set_value(caps.get(), "imu-to-sensor", &list);
  g_value_unset(&list);
  return caps;
}

}  // namespace lidar::gst
