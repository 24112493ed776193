// SPDX-License-Identifier: LGPL-2.1-or-later
// The configuration, the metadata and the state of a simulated sensor. May be used by any thread.
#pragma once
#include <array>
#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "src/ouster/metadata.h"
#include "src/tools/bench/ouster_replay/faults.h"

namespace lidar::tools {

inline constexpr std::array<const char*, 3> kTimestampModes = {
    "TIME_FROM_INTERNAL_OSC", "TIME_FROM_SYNC_PULSE_IN", "TIME_FROM_PTP_1588"};

class Sensor {
 public:
  /// Returns the sensor's metadata for a new `config`. Throws std::runtime_error if the sensor
  /// refuses `config`.
  using Rebuild = std::function<ouster::Metadata(const nlohmann::json& config)>;

  Sensor(const ouster::Metadata& metadata, const std::string& destination, Rebuild rebuild);

  std::string MetadataJson() const;
  std::string ConfigJson(bool staged) const;
  struct Change {
    bool staging = false;  // the change takes effect at the next restart
    bool restart = false;
  };
  /// Changes the configuration. Returns the error, or an empty text. The udp_dest "@auto" is
  /// replaced by `peer`.
  std::string SetConfig(const nlohmann::json& config, const Change& change,
                        const std::string& peer);
  void Restart();

  std::string MergeFaults(const nlohmann::json& change);
  Faults faults() const;

  struct Destination {
    std::string host;  // empty: nowhere
    int lidar_port = 0;
    int imu_port = 0;
    bool operator!=(const Destination& o) const {
      return host != o.host || lidar_port != o.lidar_port || imu_port != o.imu_port;
    }
  };
  Destination destination() const;

  /// Returns the new metadata, once, after a restart was requested. Only the thread that sends may
  /// call this.
  std::optional<ouster::Metadata> TakeRestart();
  void SetRunning(bool running);

 private:
  mutable std::mutex mutex_;  // guards all members below
  ouster::Metadata metadata_;
  nlohmann::json active_;
  nlohmann::json staged_;
  Rebuild rebuild_;
  bool restart_ = false;
  bool running_ = true;
  Faults faults_;
};

}  // namespace lidar::tools
