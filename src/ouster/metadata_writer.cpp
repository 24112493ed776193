// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/ouster/metadata_writer.h"

#include <nlohmann/json.hpp>
#include <vector>

namespace lidar::ouster {
namespace {

using nlohmann::json;

json TransformInMillimetres(const Transform& t) {
  json list = json::array();
  for (std::size_t i = 0; i < t.size(); ++i)
    list.push_back(i % 4 == 3 && i < 12 ? t[i] * 1e3 : t[i]);
  return list;
}

const char* ImuProfileName(ImuProfile profile) {
  switch (profile) {
    case ImuProfile::kLegacy:
      return "LEGACY";
    case ImuProfile::kAccel32Gyro32Nmea:
      return "ACCEL32_GYRO32_NMEA";
    case ImuProfile::kOff:
      break;
  }
  return "OFF";
}

json PerPixel(const std::vector<float>& angles, std::size_t columns) {
  json beams = json::array();
  for (std::size_t at = 0; at < angles.size(); at += columns)
    beams.push_back(std::vector<float>(angles.begin() + static_cast<std::ptrdiff_t>(at),
                                       angles.begin() + static_cast<std::ptrdiff_t>(at + columns)));
  return beams;
}

json BeamIntrinsics(const Metadata& m) {
  json altitude = json::array();
  json azimuth = json::array();
  for (const Beam& b : m.model.beams) {
    altitude.push_back(b.altitude_deg);
    azimuth.push_back(b.azimuth_deg);
  }
  if (!m.pixel_angles.empty()) {
    altitude = PerPixel(m.pixel_angles.altitude_deg, m.model.columns_per_scan);
    azimuth = PerPixel(m.pixel_angles.azimuth_deg, m.model.columns_per_scan);
  }
  Transform beam_to_lidar = kIdentity;
  beam_to_lidar[3] = m.model.beam_to_lidar_x_m;
  beam_to_lidar[11] = m.model.beam_to_lidar_z_m;
  return {{"beam_altitude_angles", altitude},
          {"beam_azimuth_angles", azimuth},
          {"lidar_origin_to_beam_origin_mm", m.model.beam_to_lidar_x_m * 1e3},
          {"beam_to_lidar_transform", TransformInMillimetres(beam_to_lidar)}};
}

json DataFormat(const Metadata& m) {
  json shifts = json::array();
  for (const Beam& b : m.model.beams) shifts.push_back(b.pixel_shift);
  const std::uint32_t last =
      (m.window.first + m.window.count - 1 + m.model.columns_per_scan) % m.model.columns_per_scan;
  return {{"columns_per_frame", m.model.columns_per_scan},
          {"columns_per_packet", m.format.columns_per_packet},
          {"pixels_per_column", m.format.beams},
          {"pixel_shift_by_row", shifts},
          {"column_window", {m.window.first, last}},
          {"fps", m.scans_per_second},
          {"udp_profile_lidar", std::string(ToString(m.format.profile))},
          {"udp_profile_imu", ImuProfileName(m.imu_profile)},
          {"header_type", m.format.header == HeaderType::kFusa ? "FUSA" : "STANDARD"}};
}

}  // namespace

std::string WriteMetadata(const Metadata& m) {
  json root = {
      {"sensor_info",
       {{"prod_line", m.product_line},
        {"prod_sn", m.serial_text},
        {"prod_pn", ""},
        {"build_rev", m.firmware},
        {"image_rev", m.firmware},
        {"build_date", "2024-01-01T00:00:00Z"},
        {"initialization_id", m.init_id},
        {"status", "RUNNING"}}},
      {"config_params",
       {{"lidar_mode", m.lidar_mode},
        {"timestamp_mode", m.timestamp_mode},
        {"udp_profile_lidar", std::string(ToString(m.format.profile))},
        {"udp_profile_imu", ImuProfileName(m.imu_profile)}}},
      {"lidar_data_format", DataFormat(m)},
      {"imu_data_format", {{"imu_measurements_per_packet", m.imu_measurements_per_packet}}},
      {"beam_intrinsics", BeamIntrinsics(m)},
      {"lidar_intrinsics",
       {{"lidar_to_sensor_transform", TransformInMillimetres(m.model.lidar_to_sensor)}}},
      {"imu_intrinsics", {{"imu_to_sensor_transform", TransformInMillimetres(m.imu_to_sensor)}}}};
  // The ports are left out if they are 0, because port 0 means that the stream is switched off.
  if (m.lidar_port != 0) root["config_params"]["udp_port_lidar"] = m.lidar_port;
  if (m.imu_port != 0) root["config_params"]["udp_port_imu"] = m.imu_port;
  return root.dump(2) + "\n";
}

}  // namespace lidar::ouster
