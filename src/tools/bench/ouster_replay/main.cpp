// SPDX-License-Identifier: LGPL-2.1-or-later
// ouster-replay: simulates an Ouster sensor.
#include <cmath>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>

#include "src/ouster/metadata_writer.h"
#include "src/ouster/pcap_writer.h"
#include "src/tools/bench/ouster_replay/faults.h"
#include "src/tools/bench/ouster_replay/http_api.h"
#include "src/tools/bench/ouster_replay/options.h"
#include "src/tools/bench/ouster_replay/pcap_stream.h"
#include "src/tools/bench/ouster_replay/player.h"
#include "src/tools/bench/ouster_replay/sensor.h"
#include "src/tools/bench/ouster_replay/synth_stream.h"
#include "src/tools/common/event_loop.h"
#include "src/tools/common/output_file.h"
#include "src/tools/common/program.h"

namespace lidar::tools {
namespace {

using nlohmann::json;

ouster::Metadata LoadMetadata(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::string error;
  auto metadata = ouster::ParseMetadata(text, &error);
  if (!metadata) throw std::runtime_error(path + ": " + error);
  return *std::move(metadata);
}

/// Sets the serial number, unless `serial` is 0.
void SetSerial(std::uint64_t serial, ouster::Metadata* metadata) {
  if (serial == 0) return;
  metadata->serial = serial;
  metadata->serial_text = std::to_string(serial);
}

ouster::Metadata FirstMetadata(const ReplayOptions& o) {
  ouster::Metadata m =
      o.pcap.empty() ? MakeSynthMetadata(o.synth, o.format) : LoadMetadata(o.metadata);
  if (o.lidar_port != 0) m.lidar_port = static_cast<std::uint16_t>(o.lidar_port);
  if (o.imu_port != 0) m.imu_port = static_cast<std::uint16_t>(o.imu_port);
  if (m.lidar_port == 0) m.lidar_port = 7502;
  if (m.imu_port == 0) m.imu_port = 7503;
  if (m.init_id == 0) m.init_id = 1;
  SetSerial(o.serial, &m);
  if (!o.timestamp_mode.empty()) m.timestamp_mode = o.timestamp_mode;
  return m;
}

/// Converts an azimuth window [millidegrees] to the columns within it. The azimuth decreases from
/// one column to the next.
ColumnWindow ToColumns(const json& window, std::uint32_t columns) {
  const auto start = window[0].get<double>() / 360e3;
  const auto end = window[1].get<double>() / 360e3;
  if (end - start >= 1) return {0, columns};
  const auto first = static_cast<std::uint32_t>(std::lround((1 - end) * columns)) + 1;
  const auto last = static_cast<std::uint32_t>(std::lround((1 - start) * columns));
  return {first % columns, (last + columns - first) % columns + 1};
}

/// Returns the metadata for a new `config`. Throws std::runtime_error if `config` would change the
/// lidar_mode or the udp_profile_lidar of a capture.
ouster::Metadata Rebuild(const ReplayOptions& options, const ouster::Metadata& first,
                         const json& config) {
  ouster::Metadata m = first;
  const auto profile = ouster::ProfileFromString(config["udp_profile_lidar"].get<std::string>());
  if (!profile) throw std::runtime_error("unknown udp_profile_lidar");
  const bool same = config["lidar_mode"] == first.lidar_mode && *profile == first.format.profile;
  if (!same && !options.pcap.empty())
    throw std::runtime_error("lidar_mode and udp_profile_lidar of a capture cannot be changed");
  if (options.pcap.empty()) {
    m = MakeSynthMetadata(options.synth, {config["lidar_mode"].get<std::string>(), *profile,
                                          first.format.header, first.format.columns_per_packet});
    m.window = ToColumns(config["azimuth_window"], m.model.columns_per_scan);
  }
  SetSerial(options.serial, &m);
  m.lidar_port = config["udp_port_lidar"].get<std::uint16_t>();
  m.imu_port = config["udp_port_imu"].get<std::uint16_t>();
  m.timestamp_mode = config["timestamp_mode"].get<std::string>();
  return m;
}

std::unique_ptr<PacketStream> MakeStream(const ReplayOptions& o, const ouster::Metadata& m) {
  if (o.pcap.empty()) return std::make_unique<SynthStream>(o.synth, m);
  return std::make_unique<PcapStream>(o.pcap, m, PcapStream::Options{!o.once, o.speed, o.serial});
}

int WriteFiles(const ReplayOptions& options, const ouster::Metadata& metadata) {
  const auto stream = MakeStream(options, metadata);
  const Time now = Now();
  stream->Restart({metadata.init_id, ClockAtStart(metadata.timestamp_mode, now)});
  std::string error;
  const auto writer = ouster::PcapWriter::Open(options.write_pcap, &error);
  if (!writer) throw std::runtime_error("cannot write " + options.write_pcap + ": " + error);
  const Duration end = metadata.scan_period() * options.scans;
  const Duration start = now.time_since_epoch() + UnixOffset();
  Faults faults;
  faults.Merge(options.faults);
  FaultInjector injector(options.seed);
  Time due(start);
  const auto write = [&](const std::vector<OutPacket>& packets) {
    for (const OutPacket& packet : packets) {
      const std::uint16_t port = packet.imu ? metadata.imu_port : metadata.lidar_port;
      if (!writer->Write(due, port, {packet.bytes.data(), packet.bytes.size()}))
        throw std::runtime_error("cannot write " + options.write_pcap);
    }
  };
  for (auto next = stream->Next(); next && next->due <= end; next = stream->Next()) {
    due = Time(start + next->due);
    write(injector.Apply(faults, *std::move(next)));
  }
  write(injector.Finish());
  if (!writer->Close()) throw std::runtime_error("cannot write " + options.write_pcap);
  return 0;
}

int Serve(const ReplayOptions& options, const ouster::Metadata& metadata) {
  Sensor sensor(metadata, options.destination,
                [&](const json& config) { return Rebuild(options, metadata, config); });
  sensor.MergeFaults(options.faults);
  EventLoop loop;
  Player player(options, metadata, &sensor,
                [&](const ouster::Metadata& m) { return MakeStream(options, m); });
  const auto stats = [&player] { return player.counts().ToJson().dump(); };
  std::unique_ptr<HttpApi> http;
  if (options.http)
    http = std::make_unique<HttpApi>(
        HttpApi::Options{options.http_address, options.http_port, options.old_firmware}, &sensor,
        stats);
  std::cout << json{{"http", http ? http->port() : 0},
                    {"dest", options.destination},
                    {"lidar_port", metadata.lidar_port},
                    {"imu_port", metadata.imu_port}}
                   .dump()
            << std::endl;
  RequestRealtimePriority();
  const Time end = options.duration_s > 0 ? Now() + FromSeconds(options.duration_s) : Time::max();
  loop.Run([&] {
    const Time now = Now();
    const auto wake_up = player.Pump(now);
    if (!wake_up || now >= end) return loop.Stop();
    loop.SetWakeUp(std::min(*wake_up, end));
  });
  player.Finish();
  http.reset();
  std::cout << stats() << std::endl;
  return 0;
}

int Run(const ReplayOptions& options) {
  const ouster::Metadata metadata = FirstMetadata(options);
  if (!options.write_metadata.empty())
    WriteFile(options.write_metadata, ouster::WriteMetadata(metadata));
  if (!options.write_pcap.empty()) return WriteFiles(options, metadata);
  return Serve(options, metadata);
}

}  // namespace
}  // namespace lidar::tools

int main(int argc, char** argv) {
  const auto options = lidar::tools::ParseReplayOptions(argc, argv);
  return lidar::tools::Guard("ouster-replay", [&] { return lidar::tools::Run(options); });
}
