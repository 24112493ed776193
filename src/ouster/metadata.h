// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads a sensor's metadata JSON, of old and new firmware.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/time.h"
#include "src/cloud/range_projection.h"
#include "src/cloud/sensor_model.h"
#include "src/cloud/slicing.h"
#include "src/ouster/packet_format.h"

namespace lidar::ouster {

/// The values of `udp_profile_imu`.
enum class ImuProfile { kLegacy, kAccel32Gyro32Nmea, kOff };

/// The direction of each pixel of a sensor whose beams are not turned by an encoder [degrees]. The
/// size is beams x columns, row-major.
struct PixelAngles {
  std::vector<float> azimuth_deg;
  std::vector<float> altitude_deg;

  bool empty() const { return azimuth_deg.empty(); }
};

struct Metadata {
  std::string product_line;
  std::string serial_text;
  std::uint64_t serial = 0;  // 0 if not known
  std::string firmware;
  std::uint32_t init_id = 0;  // 0 if not known
  std::string lidar_mode;
  std::string timestamp_mode;  // empty if not known
  double scans_per_second = 0;
  PacketFormat format;
  ColumnWindow window;
  SensorModel model;  // if there are pixel_angles, use only the number and order of its beams
  PixelAngles pixel_angles;
  Transform imu_to_sensor = kIdentity;  // its translation is in metres
  ImuProfile imu_profile = ImuProfile::kLegacy;
  std::uint32_t imu_measurements_per_packet = 0;
  bool switched_off = false;     // no lidar packets: profile OFF, no udp_dest, or port 0
  std::uint16_t lidar_port = 0;  // 0 if not known
  std::uint16_t imu_port = 0;

  Duration scan_period() const { return FromSeconds(1 / scans_per_second); }
  Duration packet_interval() const {
    return scan_period() * format.columns_per_packet / model.columns_per_scan;
  }
  ScanShape shape() const { return {model.columns_per_scan, format.beams, scan_period()}; }
  std::size_t imu_packet_size() const;

  static constexpr std::size_t kMaxJsonSize = 8U << 20;  // bytes; per-pixel angles take megabytes
};

/// Reads the layout with sections (`lidar_data_format`, firmware 2.0 and later) and the flat layout
/// of older clients. If the metadata is not enough to build a cloud, returns nothing and sets
/// `error` to a text for the user.
std::optional<Metadata> ParseMetadata(std::string_view json, std::string* error);

/// Returns true if sensors with these metadata send packets of the same layout and give clouds of
/// the same geometry, so that a stream may continue after a change from `a` to `b`.
bool SameGeometry(const Metadata& a, const Metadata& b);

}  // namespace lidar::ouster
