// SPDX-License-Identifier: LGPL-2.1-or-later
// Sensors modelled on data sheets, manuals and captures.
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

#include "src/cloud/sensor_model.h"
#include "src/synth/firing.h"

namespace lidar::synth {

/// A sensor unit: its beams, and its reach.
struct Sensor {
  SensorModel model;               // with a firing table, only the size of its scans is set
  const Firing* firing = nullptr;  // null: an Ouster, which the model describes
  double min_range_m = 0;
  double max_range_m = 0;
  double range_of_10_percent_m =
      0;  // distance at which a target of 10 % reflectivity returns nine times in ten
};

/// "os0-32" ... "os2-128", with 512, 1024, 2048 or 4096 columns; nothing for other names. Every
/// unit of a model has the same small errors of its beams.
std::optional<Sensor> MakeSensor(std::string_view name, std::uint32_t columns);
Sensor MakeSensor(const Firing& firing);

}  // namespace lidar::synth
