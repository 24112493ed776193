// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/demo/measurements.h"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <optional>

namespace lidar::demo {
namespace {

constexpr double kStart_s = 3;
constexpr double kAfterChange_s = 1;

/// Returns the first number that `object` has under one of `names`, or 0 if it has none.
double Pick(const nlohmann::json& object, std::initializer_list<const char*> names) {
  if (!object.is_object()) return 0;
  for (const char* name : names) {
    const auto found = object.find(name);
    if (found != object.end() && found->is_number()) return found->get<double>();
  }
  return 0;
}

}  // namespace

SenderSample ReadSample(const nlohmann::json& record) {
  const auto& sender = record.contains("sender") ? record["sender"] : nlohmann::json();
  const auto& encoder = record.contains("encoder") ? record["encoder"] : nlohmann::json();
  SenderSample s;
  s.unix_ns = record.value("unix_ns", std::int64_t{0});
  s.target_bps = Pick(sender, {"target-bitrate"});
  s.estimated_capacity_bps = Pick(sender, {"estimated-capacity"});
  s.rtt_ms = Pick(sender, {"rtt", "s-rtt"}) / 1e6;
  s.queue_delay_ms = Pick(sender, {"queue-delay", "qdelay"}) / 1e6;
  s.ref_wnd_bytes = Pick(sender, {"ref-wnd"});
  s.bytes_in_flight = Pick(sender, {"bytes-in-flight"});
  s.sender_queue_ms = Pick(sender, {"sender-queue-delay", "media-qdelay"}) / 1e6;
  if (sender.is_object() && sender.contains("links")) {
    s.target_bps = Pick(encoder, {"target-bitrate"});
    for (const auto& link : sender["links"])
      s.packets_dropped += static_cast<std::uint64_t>(Pick(link, {"packets-dropped"}));
  } else {
    s.packets_dropped = static_cast<std::uint64_t>(Pick(sender, {"packets-dropped"}));
  }
  s.step_m = Pick(encoder, {"quantization-step", "step"});
  return s;
}

std::vector<LinkPacket> ReadLinkLog(const std::string& file) {
  std::vector<LinkPacket> packets;
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);  // names of the columns
  while (std::getline(in, line)) {
    LinkPacket p;
    char fate[16] = "";
    int ecn_in = 0;
    int ecn_out = 0;
    const int fields =
        std::sscanf(line.c_str(), "%lf,%" SCNd64 ",%*d,%ld,%*d,%*d,%*d,%d,%d,%15[^,],%lf",
                    &p.time_s, &p.unix_ns, &p.size, &ecn_in, &ecn_out, fate, &p.sojourn_ms);
    if (fields != 7) continue;
    p.delivered = std::strcmp(fate, "delivered") == 0;
    p.marked = ecn_in != ecn_out;
    packets.push_back(p);
  }
  return packets;
}

std::vector<LinkPacket> ReadLinkLogs(const RunOptions& options) {
  std::vector<LinkPacket> packets;
  std::optional<std::int64_t> origin_ns;
  for (std::size_t i = 0; i < options.links; ++i) {
    for (LinkPacket p : ReadLinkLog(LinkFile(options, "packets.csv", i))) {
      p.link = i;
      const std::int64_t since_first_ns = std::llround(p.time_s * 1e9);
      if (!origin_ns) origin_ns = p.unix_ns - since_first_ns;
      p.time_s = static_cast<double>(p.unix_ns - *origin_ns) / 1e9;
      packets.push_back(p);
    }
  }
  std::stable_sort(packets.begin(), packets.end(),
                   [](const LinkPacket& a, const LinkPacket& b) { return a.time_s < b.time_s; });
  return packets;
}

void Measurements::AddBounds(std::int64_t unix_ns, double min_bps, double max_bps) {
  EndBounds(unix_ns);
  if (bounds.known_s == 0) {
    encoder_min_bps = min_bps;
    encoder_max_bps = max_bps;
  }
  bounds.since_unix_ns = unix_ns;
  bounds.min_bps = min_bps;
  bounds.max_bps = max_bps;
}

void Measurements::EndBounds(std::int64_t unix_ns) {
  const auto held_s = static_cast<double>(unix_ns - bounds.since_unix_ns) / 1e9;
  if (bounds.since_unix_ns == 0 || held_s <= 0) return;
  bounds.known_s += held_s;
  encoder_min_bps += (bounds.min_bps - encoder_min_bps) * held_s / bounds.known_s;
  encoder_max_bps += (bounds.max_bps - encoder_max_bps) * held_s / bounds.known_s;
  bounds.since_unix_ns = unix_ns;
}

bool Measurements::IsSteady(double time_s) const {
  if (time_s < kStart_s) return false;
  for (const Duration change : ChangesOf(options))
    if (time_s >= Seconds(change) && time_s < Seconds(change) + kAfterChange_s) return false;
  return true;
}

nlohmann::json LinkStats(const Measurements& m) {
  const nlohmann::json sender = m.sender_stats.is_object() && m.sender_stats.contains("sender")
                                    ? m.sender_stats["sender"]
                                    : nlohmann::json();
  return sender.is_object() ? sender.value("links", nlohmann::json::array())
                            : nlohmann::json::array();
}

nlohmann::json SumOfLinks(const std::vector<nlohmann::json>& lines) {
  nlohmann::json sum;
  for (const nlohmann::json& line : lines) {
    if (line.is_null()) continue;
    if (sum.is_null()) {
      sum = line;
      continue;
    }
    for (const char* key : {"capacity_bps", "delivered_bps", "marked", "dropped"})
      sum[key] = sum.value(key, 0.0) + line.value(key, 0.0);
    sum["sojourn_ms"]["p95"] =
        std::max(sum["sojourn_ms"].value("p95", 0.0), line["sojourn_ms"].value("p95", 0.0));
  }
  return sum;
}

}  // namespace lidar::demo
