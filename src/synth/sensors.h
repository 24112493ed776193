// SPDX-License-Identifier: LGPL-2.1-or-later
// Makes sensors according to data sheets, manuals and captures.
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

#include "src/cloud/sensor_model.h"
#include "src/synth/firing.h"

namespace lidar::synth {

/// The beams and the ranges of a sensor.
struct Sensor {
  SensorModel model;               // if `firing` is set, it has only the size of a scan
  const Firing* firing = nullptr;  // null: an Ouster, which `model` describes
  double min_range_m = 0;
  double max_range_m = 0;
  // The distance at which nine of ten pulses return from a target of 10 % reflectivity.
  double range_of_10_percent_m = 0;
};

/// Makes the sensor "os0-32" ... "os2-128" with 512, 1024, 2048 or 4096 columns. Returns nothing
/// for other values. All sensors of the same name have the same small errors in their beams.
std::optional<Sensor> MakeSensor(std::string_view name, std::uint32_t columns);
Sensor MakeSensor(const Firing& firing);

}  // namespace lidar::synth
