// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/demo/summary.h"

#include <algorithm>
#include <cstdio>
#include <limits>

#include "src/link/gaps.h"
#include "src/tools/bench/demo/verdict.h"
#include "src/tools/common/distribution.h"

namespace lidar::demo {
namespace {

using tools::Distribution;

constexpr double kShortQueue_ms = 10;
/// A queue has settled once it was shorter than kShortQueue_ms for this time.
constexpr double kSettled_s = 0.5;
/// The rounding of float coordinates adds up to 1.3e-5 m to the error of a point at 200 m. The rest
/// of this value is a margin.
constexpr double kRounding_m = 5e-5;

nlohmann::ordered_json Percentiles(const Distribution& d) {
  if (d.count() == 0) return nullptr;
  return {{"p50", d.Percentile(50)},
          {"p95", d.Percentile(95)},
          {"p99", d.Percentile(99)},
          {"max", d.Max()}};
}

struct Delays {
  Distribution all;
  Distribution steady;
  void Add(double ms, bool is_steady) {
    all.Add(ms);
    if (is_steady) steady.Add(ms);
  }
};

struct SliceFigures {
  Delays capture_to_cloud;
  Distribution capture;  // from the last column to the buffer
  // The time from the buffer to the encoded slice, including the wait for the encoder's thread.
  Distribution encode;
  Distribution network;
  Distribution decode;
  Distribution encode_scan;
  Distribution decode_scan;
  std::uint64_t bytes = 0;
  std::uint64_t returns = 0;
};

SliceFigures CollectFigures(const Measurements& m) {
  SliceFigures f;
  for (const auto& [id, scan] : m.ledger.scans()) {
    double encode_ms = 0;
    double decode_ms = 0;
    bool complete = true;
    for (const SliceLife& s : scan) {
      complete = complete && s.decoded > 0;
      if (s.encoded > 0) {
        f.bytes += s.bytes;
        f.returns += s.returns;
        f.capture.Add(Ms(s.captured - s.due));
        f.encode.Add(Ms(s.encoded - s.captured));
      }
      if (s.decoded == 0 || s.encoded == 0) continue;
      f.network.Add(Ms(s.received - s.encoded));
      f.decode.Add(s.decode_ms);
      f.capture_to_cloud.Add(Ms(s.decoded - s.due), m.IsSteady(m.Since(s.due)));
      encode_ms += s.encode_ms;
      decode_ms += s.decode_ms;
    }
    if (!complete) continue;
    f.encode_scan.Add(encode_ms);
    f.decode_scan.Add(decode_ms);
  }
  return f;
}

Delays QueueDelays(const Measurements& m) {
  Delays d;
  for (const LinkPacket& p : m.packets)
    if (p.delivered) d.Add(p.sojourn_ms, m.IsSteady(p.time_s));
  return d;
}

/// Returns the number of delivered bits, divided by the number of bits that the link can carry and
/// the source can use. Only steady times count.
nlohmann::ordered_json Utilisation(const Measurements& m, double source_max_bps) {
  if (m.options.links > 1) return nullptr;  // copies of packets fill the remaining capacity
  constexpr double kSpan_s = 0.1;
  const auto bins = static_cast<std::size_t>(m.ran_s / kSpan_s);
  std::vector<double> sent(bins);
  for (const LinkPacket& p : m.packets) {
    const auto bin = static_cast<std::size_t>(std::max(p.time_s, 0.0) / kSpan_s);
    if (p.delivered && bin < bins) sent[bin] += static_cast<double>(p.size) * 8;
  }
  const auto capacity = CapacitiesOf(m.options).front();
  double used = 0;
  double offered = 0;
  for (std::size_t i = 0; i < bins; ++i) {
    const double start = static_cast<double>(i) * kSpan_s;
    const double bits = capacity.Between(FromSeconds(start), FromSeconds(start + kSpan_s)).bits();
    if (!m.IsSteady(start)) continue;
    used += sent[i];
    offered += std::min(bits, source_max_bps * kSpan_s);
  }
  if (offered <= 0) return nullptr;
  return used / offered;
}

/// Returns the greatest bitrate of the source on the wire, or infinity if it is unknown.
double SourceMax(const Measurements& m) {
  return m.encoder_max_bps > 0 ? m.encoder_max_bps * WireShare(m)
                               : std::numeric_limits<double>::infinity();
}

void AddErrors(const Measurements& m, nlohmann::ordered_json* s) {
  const Comparison& total = m.ledger.total();
  (*s)["max_error_m"] = total.max_error_m;
  (*s)["mean_error_m"] =
      total.points > 0 ? total.sum_error_m / static_cast<double>(total.points) : 0;
  (*s)["error_bound_m"] = ErrorBoundOf(m.options);
  (*s)["points_compared"] = total.points;
  (*s)["points_missing"] = total.missing;
  (*s)["points_added"] = total.added;
}

void AddRates(const Measurements& m, nlohmann::ordered_json* s) {
  std::uint64_t marked = 0;
  std::uint64_t dropped = 0;
  double bits = 0;
  for (const LinkPacket& p : m.packets) {
    marked += p.marked;
    dropped += !p.delivered;
    bits += p.delivered ? static_cast<double>(p.size) * 8 : 0;
  }
  (*s)["mean_rate_bps"] = m.ran_s > 0 ? bits / m.ran_s : 0;
  constexpr double kAny = std::numeric_limits<double>::infinity();
  (*s)["utilisation"] = Utilisation(m, kAny);
  (*s)["utilisation_of_usable"] = Utilisation(m, SourceMax(m));
  (*s)["encoder_min_bps"] = m.encoder_min_bps;
  (*s)["encoder_max_bps"] = m.encoder_max_bps;
  (*s)["packets"] = m.packets.size();
  (*s)["packets_marked"] = marked;
  (*s)["packets_dropped_by_link"] = dropped;
  (*s)["packets_dropped_by_sender"] = m.samples.empty() ? 0 : m.samples.back().packets_dropped;
}

void AddGaps(const Measurements& m, nlohmann::ordered_json* s) {
  std::vector<link::SentPacket> sent;
  for (const LinkPacket& p : m.packets)
    sent.push_back({FromSeconds(p.time_s), DataSize::Bytes(p.size)});
  Distribution back;
  if (m.options.links == 1)
    for (const double t :
         RecoveryAfterGaps(CapacitiesOf(m.options).front(), sent,
                           {FromSeconds(m.ran_s), DataRate::BitsPerSecond(SourceMax(m))}))
      back.Add(t);
  (*s)["gaps"] = {{"count", back.count()}, {"back_after_s", Percentiles(back)}};
}

/// Adds the results of a sender with full knowledge of the link. These are the number of complete
/// scans at `encoder_min_bps`, and the delays at the mean bitrate of this run.
void AddOracle(const Measurements& m, nlohmann::ordered_json* s) {
  double bits = 0;
  for (const auto& [id, scan] : m.ledger.scans())
    for (const SliceLife& life : scan) bits += static_cast<double>(life.bytes) * 8;
  (*s)["oracle"] = nullptr;
  if (m.encoder_min_bps <= 0 || m.ran_s <= 0) return;
  const link::OracleResult mean = AskOracle(m, bits / m.ran_s);
  (*s)["oracle"] = {
      {"scans_complete", AskOracle(m, m.encoder_min_bps).complete},
      {"capture_to_cloud_ms",
       {{"p50", mean.Latency(50)}, {"p95", mean.Latency(95)}, {"p99", mean.Latency(99)}}}};
}

/// Adds the figures of each link if there are several.
void AddLinks(const Measurements& m, nlohmann::ordered_json* s) {
  const nlohmann::json links = LinkStats(m);
  if (links.empty()) return;
  (*s)["links"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < links.size(); ++i) {
    double bits = 0;
    for (const LinkPacket& p : m.packets)
      if (p.delivered && p.link == i) bits += static_cast<double>(p.size) * 8;
    (*s)["links"].push_back({{"mean_rate_bps", m.ran_s > 0 ? bits / m.ran_s : 0},
                             {"packets_first", links[i].value("packets-first", 0)},
                             {"packets_copies", links[i].value("packets-copies", 0)},
                             {"packets_saved", links[i].value("packets-saved", 0)}});
  }
}

void AddTransients(const Measurements& m, nlohmann::ordered_json* s) {
  (*s)["transients"] = nlohmann::ordered_json::array();
  for (const Transient& t : FindTransients(m))
    (*s)["transients"].push_back({{"at_s", t.at_s},
                                  {"from_bps", t.from_bps},
                                  {"to_bps", t.to_bps},
                                  {"peak_ms", t.peak_ms},
                                  {"below_10ms_after_s", t.settled_after_s}});
}

std::string Text(const char* format, double a, double b) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

}  // namespace

std::vector<Transient> FindTransients(const Measurements& m) {
  std::vector<Transient> transients;
  const auto capacity = CapacitiesOf(m.options).front();
  const auto changes = ChangesOf(m.options);
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Transient t;
    t.at_s = Seconds(changes[i]);
    t.from_bps = capacity.RateAt(changes[i] - Duration{1}).bits_per_second();
    t.to_bps = capacity.RateAt(changes[i]).bits_per_second();
    const double end = i + 1 < changes.size() ? Seconds(changes[i + 1]) : m.ran_s;
    for (const LinkPacket& p : m.packets) {
      // A packet is counted at the time when it leaves the queue, so that a long wait counts in
      // full.
      const double left = p.time_s + p.sojourn_ms / 1e3;
      if (!p.delivered || left < t.at_s || left >= end) continue;
      const bool settled = left - t.at_s - t.settled_after_s > kSettled_s;
      if (settled) break;  // later packets do not belong to this step
      t.peak_ms = std::max(t.peak_ms, p.sojourn_ms);
      if (p.sojourn_ms >= kShortQueue_ms)
        t.settled_after_s = std::max(t.settled_after_s, left - t.at_s);
    }
    if (t.at_s < m.ran_s) transients.push_back(t);
  }
  return transients;
}

std::vector<Guarantee> CheckGuarantees(const Measurements& m) {
  const Comparison& total = m.ledger.total();
  const ScanCounts n = m.ledger.Count();
  const auto s = Summarise(m);
  const double dropped =
      s["packets_dropped_by_link"].get<double>() + s["packets_dropped_by_sender"].get<double>();
  const auto lost = static_cast<double>(n.slices_lost);
  std::uint64_t decoded = 0;
  for (const auto& [id, scan] : m.ledger.scans())
    for (const SliceLife& life : scan) decoded += life.decoded > 0;
  return {
      {Text("every point within the error bound: largest %.4f m, bound %.4f m", total.max_error_m,
            ErrorBoundOf(m.options)),
       total.points > 0 && total.max_error_m <= ErrorBoundOf(m.options) + kRounding_m},
      {Text("no return vanished or appeared: %.0f missing, %.0f added",
            static_cast<double>(total.missing), static_cast<double>(total.added)),
       total.missing + total.added == 0},
      {Text("nothing lost that was not dropped: %.0f slices lost, %.0f packets dropped", lost,
            dropped),
       lost <= dropped},
      {Text("every cloud that arrived was compared: %.0f of %.0f slices",
            static_cast<double>(m.ledger.compared_slices()), static_cast<double>(decoded)),
       decoded > 0 && m.ledger.compared_slices() == decoded},
  };
}

nlohmann::ordered_json Summarise(const Measurements& m) {
  const ScanCounts n = m.ledger.Count();
  const SliceFigures f = CollectFigures(m);
  const Delays queue = QueueDelays(m);
  nlohmann::ordered_json s;
  s["duration_s"] = m.ran_s;
  s["scans_captured"] = n.captured;
  s["scans_skipped"] = n.skipped;
  s["scans_sent"] = n.sent;
  s["scans_complete"] = n.complete;
  s["scans_in_time"] = n.in_time;
  s["slices_sent"] = n.slices_sent;
  s["slices_lost"] = n.slices_lost;
  AddRates(m, &s);
  s["queue_delay_ms"] = Percentiles(queue.all);
  s["queue_delay_steady_ms"] = Percentiles(queue.steady);
  s["capture_to_cloud_ms"] = Percentiles(f.capture_to_cloud.all);
  s["capture_to_cloud_steady_ms"] = Percentiles(f.capture_to_cloud.steady);
  s["stages_ms"] = {{"capture", Percentiles(f.capture)},
                    {"encode", Percentiles(f.encode)},
                    {"network", Percentiles(f.network)},
                    {"decode", Percentiles(f.decode)}};
  AddTransients(m, &s);
  AddGaps(m, &s);
  AddLinks(m, &s);
  AddOracle(m, &s);
  AddErrors(m, &s);
  s["encode_ms_p50"] = f.encode_scan.Percentile(50);
  s["decode_ms_p50"] = f.decode_scan.Percentile(50);
  s["bits_per_return"] =
      f.returns > 0 ? static_cast<double>(f.bytes) * 8 / static_cast<double>(f.returns) : 0;
  return s;
}

}  // namespace lidar::demo
