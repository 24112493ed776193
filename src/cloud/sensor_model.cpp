// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/cloud/sensor_model.h"

#include <cmath>

#include "src/base/byte_writer.h"
#include "src/cloud/range_grid.h"

namespace lidar {
namespace {

constexpr std::uint8_t kVersion = 1;
constexpr std::size_t kTransformValues = 12;  // without the last row, which is always 0 0 0 1
constexpr double kMaxDegrees = 720;

bool IsSane(double v, double limit) { return std::isfinite(v) && std::abs(v) <= limit; }

}  // namespace

std::vector<std::uint8_t> SensorModel::Serialise() const {
  std::vector<std::uint8_t> bytes;
  ByteWriter w(&bytes);
  w.U8(kVersion);
  w.U8(0);  // flags
  w.Le16(static_cast<std::uint16_t>(beams.size()));
  w.Le16(static_cast<std::uint16_t>(columns_per_scan));
  w.Le16(static_cast<std::uint16_t>(range_unit_mm));
  w.LeF32(static_cast<float>(beam_to_lidar_x_m));
  w.LeF32(static_cast<float>(beam_to_lidar_z_m));
  for (std::size_t i = 0; i < kTransformValues; ++i)
    w.LeF32(static_cast<float>(lidar_to_sensor[i]));
  for (const Beam& b : beams) {
    w.LeF32(static_cast<float>(b.azimuth_deg));
    w.LeF32(static_cast<float>(b.altitude_deg));
    w.Le16(static_cast<std::uint16_t>(static_cast<std::int16_t>(b.pixel_shift)));
  }
  return bytes;
}

std::optional<SensorModel> SensorModel::Parse(ByteView bytes) {
  ByteReader r(bytes);
  SensorModel m;
  const std::uint8_t version = r.U8();
  const std::uint8_t flags = r.U8();
  const std::uint16_t beams = r.Le16();
  m.columns_per_scan = r.Le16();
  m.range_unit_mm = r.Le16();
  m.beam_to_lidar_x_m = static_cast<double>(r.LeF32());
  m.beam_to_lidar_z_m = static_cast<double>(r.LeF32());
  bool sane = IsSane(m.beam_to_lidar_x_m, 100) && IsSane(m.beam_to_lidar_z_m, 100);
  for (std::size_t i = 0; i < kTransformValues; ++i) {
    m.lidar_to_sensor[i] = static_cast<double>(r.LeF32());
    sane = sane && IsSane(m.lidar_to_sensor[i], 1e4);
  }
  if (!r.ok() || version != kVersion || flags != 0 || beams == 0 || beams > kMaxBeams ||
      m.columns_per_scan == 0 || m.columns_per_scan > kMaxColumns || m.range_unit_mm == 0 ||
      m.range_unit_mm > RangeGrid::kMaxUnitMm || r.remaining() != beams * std::size_t{10}) {
    return std::nullopt;
  }
  m.beams.resize(beams);
  for (Beam& b : m.beams) {
    b.azimuth_deg = static_cast<double>(r.LeF32());
    b.altitude_deg = static_cast<double>(r.LeF32());
    b.pixel_shift = static_cast<std::int16_t>(r.Le16());
    sane = sane && IsSane(b.azimuth_deg, kMaxDegrees) && IsSane(b.altitude_deg, kMaxDegrees);
  }
  if (!sane) return std::nullopt;
  return m;
}

}  // namespace lidar
