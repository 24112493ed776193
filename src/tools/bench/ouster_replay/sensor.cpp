// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/ouster_replay/sensor.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "src/ouster/metadata_writer.h"
#include "src/tools/common/udp_socket.h"

namespace lidar::tools {
namespace {

using nlohmann::json;

json FactoryConfig(const ouster::Metadata& m, const std::string& destination) {
  const bool accel = m.imu_profile == ouster::ImuProfile::kAccel32Gyro32Nmea;
  return {
      {"udp_dest", destination},
      {"udp_port_lidar", m.lidar_port},
      {"udp_port_imu", m.imu_port},
      {"lidar_mode", m.lidar_mode},
      {"udp_profile_lidar", std::string(ToString(m.format.profile))},
      {"udp_profile_imu", accel ? "ACCEL32_GYRO32_NMEA" : "LEGACY"},
      {"timestamp_mode", m.timestamp_mode.empty() ? "TIME_FROM_INTERNAL_OSC" : m.timestamp_mode},
      {"azimuth_window", {0, 360000}},
      {"signal_multiplier", 1},
      {"operating_mode", "NORMAL"}};
}

bool IsValid(const std::string& key, const json& value) {
  if (key == "signal_multiplier")
    return value == 0.25 || value == 0.5 || value == 1 || value == 2 || value == 3;
  if (key == "timestamp_mode")
    return std::find(kTimestampModes.begin(), kTimestampModes.end(), value) !=
           kTimestampModes.end();
  if (key.rfind("udp_port", 0) == 0)
    return value.is_number_unsigned() && value.get<std::uint64_t>() < 65536;
  if (key == "azimuth_window")
    return value.is_array() && value.size() == 2 && value[0].is_number_unsigned() &&
           value[1].is_number_unsigned() && value[0] <= 360000 && value[1] <= 360000;
  return value.is_string();
}

/// Returns true if packets can be sent to the address `value`. An empty text is allowed, and means
/// that no packets are sent. May wait for a name server.
bool IsDestination(const json& value) {
  if (!value.is_string()) return false;
  const auto host = value.get<std::string>();
  if (host.empty() || host == "@auto") return true;
  try {
    ResolveAddress("0", host);
  } catch (const std::runtime_error&) {
    return false;
  }
  return true;
}

std::uint32_t NextInitId(std::uint32_t id) {
  const std::uint32_t next = (id * 1'103'515'245U + 12'345U) & 0xffffffU;
  return next == 0 ? 1 : next;
}

}  // namespace

Sensor::Sensor(const ouster::Metadata& metadata, const std::string& destination, Rebuild rebuild)
    : metadata_(metadata),
      active_(FactoryConfig(metadata, destination)),
      staged_(active_),
      rebuild_(std::move(rebuild)) {}

std::string Sensor::MetadataJson() const {
  std::lock_guard lock(mutex_);
  json root = json::parse(ouster::WriteMetadata(metadata_));
  root["config_params"] = active_;
  root["sensor_info"]["status"] = running_ ? "RUNNING" : "INITIALIZING";
  return root.dump(2);
}

std::string Sensor::ConfigJson(bool staged) const {
  std::lock_guard lock(mutex_);
  return (staged ? staged_ : active_).dump(2);
}

std::string Sensor::SetConfig(const json& config, const Change& change, const std::string& peer) {
  if (!config.is_object()) return "a configuration must be a JSON object";
  if (config.contains("udp_dest") && !IsDestination(config["udp_dest"]))
    return "cannot send to udp_dest " + config["udp_dest"].dump();
  std::lock_guard lock(mutex_);
  json next = staged_;
  for (const auto& [key, value] : config.items()) {
    if (!next.contains(key) || !IsValid(key, value))
      return "cannot set " + key + " to " + value.dump();
    next[key] = key == "udp_dest" && value == "@auto" ? json(peer) : value;
  }
  try {
    rebuild_(next);
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  staged_ = next;
  if (!change.staging && !change.restart) active_ = next;
  if (change.restart) {
    restart_ = true;
    running_ = false;
  }
  return {};
}

void Sensor::Restart() {
  std::lock_guard lock(mutex_);
  restart_ = true;
  running_ = false;
}

std::string Sensor::MergeFaults(const json& change) {
  std::lock_guard lock(mutex_);
  return faults_.Merge(change);
}

Faults Sensor::faults() const {
  std::lock_guard lock(mutex_);
  return faults_;
}

Sensor::Destination Sensor::destination() const {
  std::lock_guard lock(mutex_);
  return {active_["udp_dest"].get<std::string>(), active_["udp_port_lidar"].get<int>(),
          active_["udp_port_imu"].get<int>()};
}

std::optional<ouster::Metadata> Sensor::TakeRestart() {
  std::lock_guard lock(mutex_);
  if (!std::exchange(restart_, false)) return std::nullopt;
  active_ = staged_;
  const std::uint32_t init_id = NextInitId(metadata_.init_id);
  metadata_ = rebuild_(active_);
  metadata_.init_id = init_id;
  return metadata_;
}

void Sensor::SetRunning(bool running) {
  std::lock_guard lock(mutex_);
  running_ = running;
}

}  // namespace lidar::tools
