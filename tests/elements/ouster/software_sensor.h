// SPDX-License-Identifier: LGPL-2.1-or-later
// ouster-replay inside the test program: a sensor that drives through a synthetic world and sends
// on the loopback interface.
#pragma once
#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "src/tools/bench/ouster_replay/http_api.h"
#include "src/tools/bench/ouster_replay/options.h"
#include "src/tools/bench/ouster_replay/player.h"
#include "src/tools/bench/ouster_replay/sensor.h"
#include "src/tools/common/event_loop.h"

namespace lidar::test {

class SoftwareSensor {
 public:
  struct Options {
    std::string mode = "512x20";
    std::string timestamp_mode = "TIME_FROM_INTERNAL_OSC";
    bool old_firmware = false;
    std::string destination;  // empty: sends nothing until it is configured
    std::string http_address = "127.0.0.1";
    std::string source;           // source address; empty: any
    std::string multicast_iface;  // empty: the kernel chooses
    std::uint64_t seed = 1;       // of the world and of the serial number
  };
  explicit SoftwareSensor(const Options& options) : metadata_(Make(options)) {
    replay_.boot_s = 0.1;
    replay_.source = options.source;
    replay_.multicast_iface = options.multicast_iface;
    sensor_ = std::make_unique<tools::Sensor>(
        metadata_, options.destination, [this](const nlohmann::json& config) {
          ouster::Metadata m = tools::MakeSynthMetadata(
              replay_.synth,
              {config["lidar_mode"].get<std::string>(),
               *ouster::ProfileFromString(config["udp_profile_lidar"].get<std::string>()),
               ouster::HeaderType::kStandard});
          m.lidar_port = config["udp_port_lidar"].get<std::uint16_t>();
          m.imu_port = config["udp_port_imu"].get<std::uint16_t>();
          m.timestamp_mode = config["timestamp_mode"].get<std::string>();
          return m;
        });
    player_ = std::make_unique<tools::Player>(
        replay_, metadata_, sensor_.get(), [this](const ouster::Metadata& m) {
          return std::make_unique<tools::SynthStream>(replay_.synth, m);
        });
    http_ = std::make_unique<tools::HttpApi>(
        tools::HttpApi::Options{options.http_address, 0, options.old_firmware}, sensor_.get(),
        [] { return std::string("{}"); });
    thread_ = std::thread([this] { Run(); });
  }
  ~SoftwareSensor() {
    stopping_ = true;
    thread_.join();
  }
  SoftwareSensor(const SoftwareSensor&) = delete;
  SoftwareSensor& operator=(const SoftwareSensor&) = delete;

  std::string host() const { return "127.0.0.1:" + port(); }
  std::string port() const { return std::to_string(http_->port()); }
  const std::string& serial() const { return metadata_.serial_text; }
  tools::Sensor& state() { return *sensor_; }
  tools::FaultCounts counts() const { return player_->counts(); }
  void Fault(const nlohmann::json& change) { ASSERT_EQ(sensor_->MergeFaults(change), ""); }
  nlohmann::json config() const { return nlohmann::json::parse(sensor_->ConfigJson(false)); }

 private:
  ouster::Metadata Make(const Options& options) {
    replay_.synth.model = "os0-32";
    replay_.synth.seed = options.seed;
    ouster::Metadata m = tools::MakeSynthMetadata(
        replay_.synth,
        {options.mode, ouster::Profile::kRng19Rfl8Sig16Nir16, ouster::HeaderType::kStandard});
    m.timestamp_mode = options.timestamp_mode;
    return m;
  }
  void Run() {
    while (!stopping_) {
      const auto next = player_->Pump(tools::Now());
      const Duration wait = next ? *next - tools::Now() : std::chrono::milliseconds(5);
      if (wait > Duration{0}) std::this_thread::sleep_for(wait);
    }
  }

  tools::ReplayOptions replay_;
  ouster::Metadata metadata_;
  std::unique_ptr<tools::Sensor> sensor_;
  std::unique_ptr<tools::Player> player_;
  std::unique_ptr<tools::HttpApi> http_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace lidar::test
