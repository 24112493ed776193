// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/ouster/metadata.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "src/ouster/json_text.h"

namespace lidar::ouster {
namespace {

using nlohmann::json;

constexpr std::size_t kTransformSize = 16;
constexpr double kMaxAngleDeg = 720;
constexpr double kMaxTranslationMm = 100'000;
constexpr double kSlowestScans = 0.1;  // scans per second
constexpr double kFastestScans = 100;
constexpr std::size_t kMaxPixels = std::size_t{1} << 22;  // per scan; bounds the memory of a scan

/// Finds a key in its section, or at the top level, where the flat layout has all keys.
class Document {
 public:
  explicit Document(const json& root) : root_(root) {}

  const json* Find(const char* section, const char* key) const {
    const json* in_section = Member(Section(section), key);
    return in_section != nullptr ? in_section : Member(&root_, key);
  }
  std::string Text(const char* section, const char* key) const {
    const json* v = Find(section, key);
    return v != nullptr && v->is_string() ? v->get<std::string>() : std::string();
  }
  /// Returns nothing if the key is missing, or if its value is not a number within [0, max].
  std::optional<double> Number(const char* section, const char* key, double max) const {
    const json* v = Find(section, key);
    if (v == nullptr || !v->is_number()) return std::nullopt;
    const auto number = v->get<double>();
    if (!(number >= 0 && number <= max)) return std::nullopt;
    return number;
  }
  std::optional<std::uint32_t> Count(const char* section, const char* key, double max) const {
    const auto number = Number(section, key, max);
    if (!number || *number != std::floor(*number)) return std::nullopt;
    return static_cast<std::uint32_t>(*number);
  }

 private:
  static const json* Member(const json* object, const char* key) {
    if (object == nullptr || !object->is_object()) return nullptr;
    const auto found = object->find(key);
    return found == object->end() ? nullptr : &*found;
  }
  const json* Section(const char* name) const {
    const json* section = Member(&root_, name);
    // The flat layout calls this section "data_format".
    return section == nullptr && std::string_view(name) == "lidar_data_format"
               ? Member(&root_, "data_format")
               : section;
  }
  const json& root_;
};

template <class Number>
std::optional<Number> ParseNumber(std::string_view text) {
  Number value{};
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
  if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

struct LidarMode {
  std::uint32_t columns = 0;
  double scans_per_second = 0;
};
/// Parses a text such as "1024x10".
std::optional<LidarMode> ParseLidarMode(std::string_view text) {
  const std::size_t x = text.find('x');
  if (x == std::string_view::npos) return std::nullopt;
  const auto columns = ParseNumber<std::uint32_t>(text.substr(0, x));
  const auto rate = ParseNumber<std::uint32_t>(text.substr(x + 1));
  if (!columns || !rate) return std::nullopt;
  return LidarMode{*columns, static_cast<double>(*rate)};
}

/// Returns the distance from the lidar's origin to the beams' origin [mm] for metadata without it.
/// The distance depends on the product line.
double DefaultBeamOriginMm(std::string_view product_line) {
  if (product_line.rfind("OS-0-", 0) == 0) return 27.67;
  if (product_line.rfind("OS-1-", 0) == 0) return 15.806;
  if (product_line.rfind("OS-2-", 0) == 0) return 13.762;
  return 12.163;
}

/// Builds Metadata step by step. The first step that fails sets the error.
class Builder {
 public:
  explicit Builder(const json& root) : document_(root) {}

  std::optional<Metadata> Build(std::string* error) {
    ReadIdentity();
    if (ReadScan() && ReadFormat() && ReadWindow() && ReadAngles() && ReadPixelShifts() &&
        ReadTransforms())
      return std::move(m_);
    *error = error_;
    return std::nullopt;
  }

 private:
  static constexpr const char* kInfo = "sensor_info";
  static constexpr const char* kConfig = "config_params";
  static constexpr const char* kFormat = "lidar_data_format";
  static constexpr const char* kBeams = "beam_intrinsics";

  bool Fail(std::string why) {
    error_ = std::move(why);
    return false;
  }

  void ReadIdentity() {
    m_.product_line = document_.Text(kInfo, "prod_line");
    m_.serial_text = document_.Text(kInfo, "prod_sn");
    m_.serial = ParseNumber<std::uint64_t>(m_.serial_text).value_or(0);
    m_.firmware = document_.Text(kInfo, "build_rev");
    m_.init_id = document_.Count(kInfo, "initialization_id", 0xffffff).value_or(0);
    m_.lidar_mode = document_.Text(kConfig, "lidar_mode");
    m_.timestamp_mode = document_.Text(kConfig, "timestamp_mode");
    const auto port = [&](const char* key) {
      return static_cast<std::uint16_t>(document_.Count(kConfig, key, 65535).value_or(0));
    };
    m_.lidar_port = port("udp_port_lidar");
    m_.imu_port = port("udp_port_imu");
  }

  bool ReadScan() {
    const auto mode = ParseLidarMode(m_.lidar_mode);
    auto columns = document_.Count(kFormat, "columns_per_frame", SensorModel::kMaxColumns);
    if (!columns && mode) columns = mode->columns;
    if (!columns || *columns == 0 || *columns > SensorModel::kMaxColumns)
      return Fail("lidar_data_format.columns_per_frame and lidar_mode are missing or wrong");
    m_.model.columns_per_scan = *columns;
    auto rate = document_.Number(kFormat, "fps", kFastestScans);
    if ((!rate || *rate <= 0) && mode) rate = mode->scans_per_second;
    if (!rate || !(*rate >= kSlowestScans && *rate <= kFastestScans))
      return Fail("lidar_data_format.fps and lidar_mode are missing or wrong");
    m_.scans_per_second = *rate;
    return true;
  }

  /// Returns `missing` if the key is missing, and 0 if its value is wrong.
  std::uint32_t CountOr(const char* key, std::size_t missing, std::uint32_t max) const {
    if (document_.Find(kFormat, key) != nullptr)
      return document_.Count(kFormat, key, max).value_or(0);
    return missing <= max ? static_cast<std::uint32_t>(missing) : 0;
  }

  bool ReadFormat() {
    const std::string profile = document_.Text(kFormat, "udp_profile_lidar");
    if (!profile.empty()) {
      const auto known = ProfileFromString(profile);
      if (!known) return Fail("udp_profile_lidar " + profile + " is not known");
      m_.format.profile = *known;
    }
    const std::string header = document_.Text(kFormat, "header_type");
    const bool fusa =
        header.empty() ? m_.format.profile == Profile::kFusaRng15Rfl8Nir8Dual : header == "FUSA";
    m_.format.header = fusa ? HeaderType::kFusa : HeaderType::kStandard;
    const json* angles = document_.Find(kBeams, "beam_altitude_angles");
    const std::size_t listed = angles != nullptr && angles->is_array() ? angles->size() : 0;
    m_.format.beams = CountOr("pixels_per_column", listed, SensorModel::kMaxBeams);
    m_.format.columns_per_packet = CountOr("columns_per_packet", 16, 65535);
    if (m_.format.beams == 0 || m_.format.columns_per_packet == 0)
      return Fail("lidar_data_format.pixels_per_column or columns_per_packet is missing or wrong");
    if (std::size_t{m_.format.beams} * m_.model.columns_per_scan > kMaxPixels)
      return Fail("lidar_data_format describes scans larger than any sensor's");
    if (m_.format.packet_size() > PacketFormat::kMaxPacketSize)
      return Fail("lidar_data_format describes packets larger than UDP can carry");
    m_.switched_off = m_.format.profile == Profile::kOff || GoesNowhere();
    m_.model.range_unit_mm = m_.format.range_unit_mm();
    ReadImuFormat();
    return true;
  }

  /// Returns true if the sensor is set to send no lidar packets.
  bool GoesNowhere() const {
    const json* destination = document_.Find(kConfig, "udp_dest");
    const json* port = document_.Find(kConfig, "udp_port_lidar");
    return (destination != nullptr && destination->is_string() &&
            destination->get_ref<const std::string&>().empty()) ||
           (port != nullptr && port->is_number() && port->get<double>() == 0);
  }

  void ReadImuFormat() {
    const std::string profile = document_.Text(kFormat, "udp_profile_imu");
    if (profile == "ACCEL32_GYRO32_NMEA") m_.imu_profile = ImuProfile::kAccel32Gyro32Nmea;
    if (profile == "OFF") m_.imu_profile = ImuProfile::kOff;
    m_.imu_measurements_per_packet =
        document_.Count("imu_data_format", "imu_measurements_per_packet", 1024).value_or(0);
  }

  bool ReadWindow() {
    const std::uint32_t columns = m_.model.columns_per_scan;
    m_.window = {0, columns};
    const json* window = document_.Find(kFormat, "column_window");
    if (window == nullptr || window->is_null()) return true;
    const auto is_column = [&](const json& v) {
      return v.is_number_unsigned() && v.get<std::uint64_t>() < columns;
    };
    if (!window->is_array() || window->size() != 2 || !is_column((*window)[0]) ||
        !is_column((*window)[1]))
      return Fail("lidar_data_format.column_window must be two columns of the scan");
    const auto first = (*window)[0].get<std::uint32_t>();
    const auto last = (*window)[1].get<std::uint32_t>();
    m_.window = {first, (last + columns - first) % columns + 1};
    return true;
  }

  /// Reads a list with one entry for each beam. An entry is an angle, or a list with one angle for
  /// each column.
  bool ReadAngleList(const char* key, std::vector<float>* angles, bool* per_pixel) {
    const json* list = document_.Find(kBeams, key);
    const std::string name = std::string("beam_intrinsics.") + key;
    if (list == nullptr || !list->is_array() || list->size() != m_.format.beams)
      return Fail(name + " must be a list with an entry for each beam (pixels_per_column)");
    const auto take = [&](const json& v) {
      if (!v.is_number()) return false;
      const auto degrees = v.get<double>();
      angles->push_back(static_cast<float>(degrees));
      return std::isfinite(degrees) && std::abs(degrees) <= kMaxAngleDeg;
    };
    *per_pixel = (*list)[0].is_array();
    for (const json& beam : *list) {
      if (beam.is_array() != *per_pixel) return Fail(name + " mixes numbers and lists");
      if (!*per_pixel) {
        if (!take(beam)) return Fail(name + " has an entry that is not an angle");
        continue;
      }
      if (beam.size() != m_.model.columns_per_scan)
        return Fail(name + " must list an angle for each column of the scan");
      if (!std::all_of(beam.begin(), beam.end(), take))
        return Fail(name + " has an entry that is not an angle");
    }
    return true;
  }

  bool ReadAngles() {
    PixelAngles angles;
    bool altitude_per_pixel = false;
    bool azimuth_per_pixel = false;
    if (!ReadAngleList("beam_altitude_angles", &angles.altitude_deg, &altitude_per_pixel) ||
        !ReadAngleList("beam_azimuth_angles", &angles.azimuth_deg, &azimuth_per_pixel))
      return false;
    if (altitude_per_pixel != azimuth_per_pixel)
      return Fail(
          "of beam_altitude_angles and beam_azimuth_angles, one has numbers and the other has "
          "lists");
    const std::size_t per_beam = altitude_per_pixel ? m_.model.columns_per_scan : 1;
    m_.model.beams.resize(m_.format.beams);
    for (std::size_t i = 0; i < m_.model.beams.size(); ++i) {
      // A beam with one angle for each column is represented by the angle of its middle column.
      const std::size_t at = i * per_beam + per_beam / 2;
      m_.model.beams[i].azimuth_deg = static_cast<double>(angles.azimuth_deg[at]);
      m_.model.beams[i].altitude_deg = static_cast<double>(angles.altitude_deg[at]);
    }
    if (altitude_per_pixel) m_.pixel_angles = std::move(angles);
    return true;
  }

  bool ReadPixelShifts() {
    const json* shifts = document_.Find(kFormat, "pixel_shift_by_row");
    if (shifts == nullptr || !shifts->is_array() || shifts->size() != m_.format.beams) return true;
    const auto limit = static_cast<int>(m_.model.columns_per_scan);
    for (std::size_t i = 0; i < m_.model.beams.size(); ++i) {
      const json& shift = (*shifts)[i];
      if (!shift.is_number_integer() || shift.get<std::int64_t>() < -limit ||
          shift.get<std::int64_t>() > limit)
        return Fail("lidar_data_format.pixel_shift_by_row has an entry that is not a shift");
      m_.model.beams[i].pixel_shift = shift.get<int>();
    }
    return true;
  }

  /// Reads a transform and converts its translation from millimetres to metres. If the transform is
  /// missing, leaves `out` unchanged.
  bool ReadTransform(const char* section, const char* key, Transform* out) {
    const json* list = document_.Find(section, key);
    if (list == nullptr || list->is_null()) return true;
    if (!list->is_array() || list->size() != kTransformSize)
      return Fail(std::string(key) + " must have 16 numbers");
    for (std::size_t i = 0; i < kTransformSize; ++i) {
      const json& v = (*list)[i];
      const double number = v.is_number() ? v.get<double>() : static_cast<double>(NAN);
      if (!(std::abs(number) <= kMaxTranslationMm))
        return Fail(std::string(key) + " has an entry that is not a number of a transform");
      const bool is_translation = i % 4 == 3 && i < 12;
      (*out)[i] = is_translation ? number * 1e-3 : number;
    }
    return true;
  }

  bool ReadTransforms() {
    m_.model.lidar_to_sensor = {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0.03618, 0, 0, 0, 1};
    m_.imu_to_sensor = {1, 0, 0, 0.006253, 0, 1, 0, -0.011775, 0, 0, 1, 0.007645, 0, 0, 0, 1};
    const double origin_mm =
        document_.Number(kBeams, "lidar_origin_to_beam_origin_mm", kMaxTranslationMm)
            .value_or(DefaultBeamOriginMm(m_.product_line));
    Transform beam_to_lidar = kIdentity;
    beam_to_lidar[3] = origin_mm * 1e-3;
    if (!ReadTransform("lidar_intrinsics", "lidar_to_sensor_transform",
                       &m_.model.lidar_to_sensor) ||
        !ReadTransform("imu_intrinsics", "imu_to_sensor_transform", &m_.imu_to_sensor) ||
        !ReadTransform(kBeams, "beam_to_lidar_transform", &beam_to_lidar))
      return false;
    m_.model.beam_to_lidar_x_m = beam_to_lidar[3];
    m_.model.beam_to_lidar_z_m = beam_to_lidar[11];
    return true;
  }

  Document document_;
  Metadata m_;
  std::string error_;
};

}  // namespace

std::size_t Metadata::imu_packet_size() const {
  constexpr std::size_t kHeaderAndFooter = 64;
  constexpr std::size_t kNmea = 100;
  constexpr std::size_t kMeasurement = 36;
  switch (imu_profile) {
    case ImuProfile::kLegacy:
      return 48;
    case ImuProfile::kAccel32Gyro32Nmea:
      return kHeaderAndFooter + kNmea + kMeasurement * imu_measurements_per_packet;
    case ImuProfile::kOff:
      break;
  }
  return 0;
}

std::optional<Metadata> ParseMetadata(std::string_view text, std::string* error) {
  if (text.size() > Metadata::kMaxJsonSize) {
    *error = "it is larger than any sensor's metadata";
    return std::nullopt;
  }
  const json root = ParseJsonObject(text);
  if (root.is_discarded()) {
    *error = "it is not a JSON object";
    return std::nullopt;
  }
  return Builder(root).Build(error);
}

bool SameGeometry(const Metadata& a, const Metadata& b) {
  return a.model.Serialise() == b.model.Serialise() && a.format.profile == b.format.profile &&
         a.format.header == b.format.header &&
         a.format.columns_per_packet == b.format.columns_per_packet &&
         a.window.first == b.window.first && a.window.count == b.window.count &&
         a.scan_period() == b.scan_period() &&
         a.pixel_angles.azimuth_deg == b.pixel_angles.azimuth_deg &&
         a.pixel_angles.altitude_deg == b.pixel_angles.altitude_deg;
}

}  // namespace lidar::ouster
