// SPDX-License-Identifier: LGPL-2.1-or-later
// A small sensor and its scans of a room, for the tests of the codecs and of their elements.
#pragma once
#include <cmath>
#include <cstdint>
#include <random>

#include "src/cloud/range_projection.h"
#include "src/cloud/sensor_model.h"
#include "src/codec/cloud_io.h"

namespace lidar::test {

inline SensorModel RoomSensor(std::uint32_t beams = 32, std::uint32_t unit_mm = 1) {
  SensorModel m;
  m.columns_per_scan = 512;
  m.range_unit_mm = unit_mm;
  m.beam_to_lidar_x_m = 0.0158;
  m.beam_to_lidar_z_m = 0.0021;
  for (std::uint32_t b = 0; b < beams; ++b) {
    const int shift = 12 - 8 * static_cast<int>(b % 4);
    m.beams.push_back({shift * 360.0 / 512, 20 - 40.0 * b / beams, shift});
  }
  return m;
}

/// Returns a scan of a room of 20 m x 12 m. The walls are noisy, and a window gives no returns.
inline codec::RangeImage RoomScan(const SensorModel& model, std::uint32_t first_column = 0,
                                  std::uint32_t columns = 512, std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  codec::RangeImage image;
  image.beams = static_cast<std::uint32_t>(model.beams.size());
  image.columns = columns;
  image.first_column = first_column;
  for (const Beam& beam : model.beams) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const double azimuth =
          2 * M_PI * (first_column + i) / model.columns_per_scan + beam.azimuth_deg * M_PI / 180;
      const double wall =
          std::min(10 / std::abs(std::cos(azimuth) + 1e-9), 6 / std::abs(std::sin(azimuth) + 1e-9));
      const double range_mm = 1e3 * wall / std::cos(beam.altitude_deg * M_PI / 180) +
                              static_cast<double>(random() % 21) - 10;
      const bool window = std::cos(azimuth) > 0.95 && beam.altitude_deg > 5;
      const bool lost = window || random() % 50 == 0;
      const auto units = static_cast<std::uint32_t>(range_mm / model.range_unit_mm);
      image.ranges.push_back(lost ? 0 : units * model.range_unit_mm);
      image.intensity.push_back(
          lost ? std::uint8_t{0}
               : static_cast<std::uint8_t>(100 + 80 * std::cos(3 * azimuth) +
                                           static_cast<double>(random() % 12)));
    }
  }
  return image;
}

/// Returns a layout of 20 bytes per point: x, y, z, intensity and range.
inline codec::CloudLayout OrganisedLayout() {
  return {*PointFields::Parse("x:F32:0,y:F32:4,z:F32:8,intensity:F32:12,range:U32:16"), 20};
}

/// Returns the bytes of `image` in the layout OrganisedLayout().
inline std::vector<std::uint8_t> RawCloud(const SensorModel& model,
                                          const codec::RangeImage& image) {
  std::vector<std::uint8_t> raw(image.size() * 20);
  codec::WriteRangeImage(image, codec::IntensityScale(codec::FullScale::kByte, 8),
                         RangeProjection(model), OrganisedLayout(), raw.data());
  return raw;
}

}  // namespace lidar::test
