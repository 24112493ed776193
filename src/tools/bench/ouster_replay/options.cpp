// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/ouster_replay/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <map>

#include "src/tools/bench/ouster_replay/faults.h"
#include "src/tools/bench/ouster_replay/sensor.h"
#include "src/tools/common/program.h"

namespace lidar::tools {
namespace {

using nlohmann::json;

constexpr double kLongest_s = 1e9;  // times in 64-bit nanoseconds can be 9 times as long

struct Text {
  std::string profile = "RNG19_RFL8_SIG16_NIR16";
  std::string header = "STANDARD";
  std::vector<std::string> events;
  double loss = 0;
  double reorder = 0;
  double duplicate = 0;
  double corrupt = 0;
};

void AddSource(CLI::App* app, ReplayOptions* o, Text* t) {
  auto* pcap = app->add_option("--pcap", o->pcap, "Capture to send")->check(CLI::ExistingFile);
  app->add_option("--metadata", o->metadata, "Metadata JSON of the capture")
      ->check(CLI::ExistingFile);
  app->add_flag("--once", o->once, "Stop at the end of the capture instead of starting over");
  app->add_option("--speed", o->speed, "Factor of the capture's speed")
      ->check(CLI::Range(0.01, 100.0));
  app->add_option("--synthesize", o->synth.model, "Model to synthesise: os0-32 ... os2-128")
      ->excludes(pcap);
  app->add_option("--mode", o->format.mode, "Mode, as 1024x10");
  app->add_option("--profile", t->profile, "Packet profile, as RNG19_RFL8_SIG16_NIR16_DUAL");
  app->add_option("--header", t->header, "Packet header")
      ->check(CLI::IsMember({"STANDARD", "FUSA"}));
  app->add_option("--columns-per-packet", o->format.columns_per_packet, "16 on most sensors")
      ->check(CLI::Range(1, 512));
  const std::map<std::string, synth::SceneKind> scenes = {{"street", synth::SceneKind::kStreet},
                                                          {"tunnel", synth::SceneKind::kTunnel},
                                                          {"field", synth::SceneKind::kField}};
  app->add_option("--scene", o->synth.scene, "World: street, tunnel or field")
      ->transform(CLI::CheckedTransformer(scenes));
  app->add_option("--drive", o->synth.speed_mps, "Speed of the car [m/s]")
      ->check(CLI::Range(0.0, 100.0));
  app->add_option("--seed", o->synth.seed, "Seed of the world and of the faults");
}

void AddSending(CLI::App* app, ReplayOptions* o) {
  const auto port = CLI::Range(0, 65535);
  app->add_option("--dest", o->destination,
                  "Where packets go until udp_dest is set; \"\": nowhere");
  app->add_option("--source", o->source, "Address of this machine to send from");
  app->add_option("--multicast-iface", o->multicast_iface,
                  "Interface to send from if udp_dest is a multicast group");
  app->add_option("--serial", o->serial, "Serial number to have; 0: as in the metadata")
      ->check(CLI::Range(std::uint64_t{0}, (std::uint64_t{1} << 40) - 1));
  app->add_option("--lidar-port", o->lidar_port, "0: as in the metadata")->check(port);
  app->add_option("--imu-port", o->imu_port, "0: as in the metadata")->check(port);
  app->add_option("--timestamp-mode", o->timestamp_mode,
                  "TIME_FROM_INTERNAL_OSC, or TIME_FROM_PTP_1588 (this machine's time as TAI)")
      ->check(
          CLI::IsMember(std::vector<std::string>(kTimestampModes.begin(), kTimestampModes.end())));
  app->add_option("--http-address", o->http_address, "Address of the HTTP API");
  app->add_option("--http-port", o->http_port, "Port of the HTTP API; 0: any free one")
      ->check(port);
  app->add_flag("!--no-http", o->http, "Serve no HTTP API");
  app->add_flag("--old-firmware", o->old_firmware, "The HTTP API of firmware before 2.4");
  app->add_option("--boot", o->boot_s, "Duration of a restart [s]")->check(CLI::Range(0.0, 3600.0));
  app->add_option("--duration", o->duration_s, "Stop after [s]; 0: never")
      ->check(CLI::Range(0.0, kLongest_s));
  app->add_option("--write-pcap", o->write_pcap, "Write a capture instead of sending");
  app->add_option("--write-metadata", o->write_metadata, "Write the metadata JSON");
  app->add_option("--scans", o->scans, "Scans to write")->check(CLI::Range(1, 1'000'000));
}

void AddFaults(CLI::App* app, Text* t) {
  const auto share = CLI::Range(0.0, 1.0);
  app->add_option("--loss", t->loss, "Share of the packets that get lost")->check(share);
  app->add_option("--reorder", t->reorder, "... that come behind the next one")->check(share);
  app->add_option("--duplicate", t->duplicate, "... that come twice")->check(share);
  app->add_option("--corrupt", t->corrupt, "... that have a wrong bit")->check(share);
  app->add_option("--at", t->events,
                  "Fault at a time, as '5 {\"silent\":true}': loss, reorder, duplicate, corrupt, "
                  "silent, wrong_size, http_status, http_delay_ms, restart");
}

ReplayOptions::Event ParseEvent(const std::string& text) {
  char* end = nullptr;
  ReplayOptions::Event event;
  event.at_s = std::strtod(text.c_str(), &end);
  event.faults = json::parse(end, nullptr, false);
  const bool is_event = end != text.c_str() && event.at_s >= 0 && event.at_s <= kLongest_s &&
                        event.faults.is_object();
  const json restart = is_event ? event.faults.value("restart", json(false)) : json();
  if (!restart.is_boolean())
    throw CLI::ValidationError("--at", "\"" + text + "\" must be like 5 {\"silent\":true}");
  event.restart = restart;
  event.faults.erase("restart");
  const std::string error = Faults{}.Merge(event.faults);
  if (!error.empty()) throw CLI::ValidationError("--at", error);
  return event;
}

void Convert(const Text& t, ReplayOptions* o) {
  const auto profile = ouster::ProfileFromString(t.profile);
  if (!profile) throw CLI::ValidationError("--profile", "there is no profile " + t.profile);
  o->format.profile = *profile;
  o->format.header = t.header == "FUSA" || *profile == ouster::Profile::kFusaRng15Rfl8Nir8Dual
                         ? ouster::HeaderType::kFusa
                         : ouster::HeaderType::kStandard;
  if (o->pcap.empty() != o->metadata.empty())
    throw CLI::ValidationError("--pcap", "--pcap and --metadata must be given together");
  if (!o->write_pcap.empty() && !t.events.empty())
    throw CLI::ValidationError("--at", "cannot be used with --write-pcap");
  o->seed = o->synth.seed;
  o->faults = {
      {"loss", t.loss}, {"reorder", t.reorder}, {"duplicate", t.duplicate}, {"corrupt", t.corrupt}};
  for (const std::string& event : t.events) o->events.push_back(ParseEvent(event));
  std::stable_sort(o->events.begin(), o->events.end(),
                   [](const auto& a, const auto& b) { return a.at_s < b.at_s; });
}

}  // namespace

ReplayOptions ParseReplayOptions(int argc, char** argv) {
  ReplayOptions options;
  Text text;
  CLI::App app(
      "An Ouster sensor in software: sends a capture, or a drive through a synthetic world, as "
      "lidar and IMU packets, answers the HTTP API, and misbehaves on request.");
  AddVersionFlag(&app, "ouster-replay");
  AddSource(&app, &options, &text);
  AddSending(&app, &options);
  AddFaults(&app, &text);
  Parse(&app, argc, argv, [&] { Convert(text, &options); });
  return options;
}

}  // namespace lidar::tools
