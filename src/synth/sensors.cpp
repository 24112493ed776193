// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/synth/sensors.h"

#include <array>
#include <charconv>
#include <cmath>

#include "src/synth/random.h"

namespace lidar::synth {
namespace {

struct Family {
  std::string_view name;
  double half_view_deg;  // altitude of the outermost beams
  double bulge;  // how much farther apart beams are at the edge of the view than in its middle
  double stagger_deg;  // azimuth of the outermost of the four emitter columns
  double origin_m;     // lidar_origin_to_beam_origin
  double min_range_m;
  double max_range_m;
  double range_of_10_percent_m;
};

constexpr std::array<Family, 3> kFamilies = {{{"os0", 45.6, 0.06, 10.9, 0.027116, 0.3, 75, 40},
                                              {"os1", 21.4, 0.03, 4.22, 0.015806, 0.3, 170, 90},
                                              {"os2", 10.6, 0.02, 2.11, 0.013762, 0.8, 350, 200}}};

/// Returns the azimuth of a beam. The four emitter columns of an Ouster are at 1, 1/3, -1/3 and -1
/// times the stagger. A sensor of 32 beams uses every fourth beam, so it has only one column.
double AzimuthOf(const Family& family, std::uint32_t beam, std::uint32_t beams) {
  const std::uint32_t column = beams == 32 ? 2 : beam % 4;
  return family.stagger_deg * (1.0 - column * 2.0 / 3.0);
}

Beam MakeBeam(const Family& family, std::uint32_t beam, std::uint32_t beams) {
  Random calibration(beams, static_cast<std::uint64_t>(family.name[2]), beam);
  const double position = 1.0 - 2.0 * beam / (beams - 1.0);
  Beam b;
  b.altitude_deg =
      family.half_view_deg * position * (1.0 - family.bulge * (1.0 - position * position)) +
      static_cast<double>(calibration.Uniform(-0.04F, 0.04F));
  b.azimuth_deg =
      AzimuthOf(family, beam, beams) + static_cast<double>(calibration.Uniform(-0.04F, 0.04F));
  return b;
}

Sensor Build(const Family& family, std::uint32_t beams, std::uint32_t columns) {
  Sensor sensor;
  sensor.min_range_m = family.min_range_m;
  sensor.max_range_m = family.max_range_m;
  sensor.range_of_10_percent_m = family.range_of_10_percent_m;
  SensorModel& model = sensor.model;
  model.columns_per_scan = columns;
  model.beam_to_lidar_x_m = family.origin_m;
  model.lidar_to_sensor = {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0.03618, 0, 0, 0, 1};
  for (std::uint32_t i = 0; i < beams; ++i) {
    Beam beam = MakeBeam(family, i, beams);
    beam.pixel_shift = static_cast<int>(std::lround(beam.azimuth_deg * columns / 360.0));
    model.beams.push_back(beam);
  }
  return sensor;
}

}  // namespace

std::optional<Sensor> MakeSensor(std::string_view name, std::uint32_t columns) {
  if (columns != 512 && columns != 1024 && columns != 2048 && columns != 4096) return std::nullopt;
  for (const Family& family : kFamilies) {
    if (name.substr(0, 3) != family.name || name.substr(3, 1) != "-") continue;
    const std::string_view digits = name.substr(4);
    std::uint32_t beams = 0;
    const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), beams);
    if (parsed.ptr == digits.data() + digits.size() &&
        (beams == 32 || beams == 64 || beams == 128)) {
      Sensor sensor = Build(family, beams, columns);
      // Rounds the model as caps do, so that the sender and the receiver convert ranges to the same
      // points.
      const auto bytes = sensor.model.Serialise();
      sensor.model = *SensorModel::Parse({bytes.data(), bytes.size()});
      return sensor;
    }
  }
  return std::nullopt;
}

Sensor MakeSensor(const Firing& firing) {
  Sensor sensor;
  sensor.min_range_m = firing.min_range_m;
  sensor.max_range_m = firing.max_range_m;
  sensor.range_of_10_percent_m = firing.range_of_10_percent_m;
  sensor.firing = &firing;
  sensor.model.columns_per_scan = firing.columns;
  sensor.model.range_unit_mm = firing.range_unit_mm;
  sensor.model.beams.resize(firing.lasers);
  return sensor;
}

}  // namespace lidar::synth
