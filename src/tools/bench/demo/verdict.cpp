// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/demo/verdict.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace lidar::demo {
namespace {

constexpr double kUseful = 0.9;  // share of the scans that the oracle completes
constexpr double kOfSomeUse = 0.5;
constexpr double kMostly = 0.5;  // share of the run's time

template <class... Args>
std::string Text(const char* format, Args... args) {
  char text[240];
  std::snprintf(text, sizeof text, format, args...);
  return text;
}

/// Returns the share of the run's time in which at least one link could carry more than the source
/// can use.
double ShareAbove(const Measurements& m, double source_max_bps) {
  constexpr Duration kStep = std::chrono::milliseconds(100);
  const auto links = CapacitiesOf(m.options);
  const auto carries = [&](Duration t) {
    return std::any_of(links.begin(), links.end(), [&](const link::Capacity& c) {
      return c.RateAt(t).bits_per_second() > source_max_bps;
    });
  };
  const Duration end = FromSeconds(m.ran_s);
  std::int64_t above = 0;
  for (Duration t{0}; t < end; t += kStep) above += carries(t);
  return static_cast<double>(above) / std::max(1.0, m.ran_s / Seconds(kStep));
}

std::vector<std::string> Hints(const Measurements& m, const ScanCounts& n) {
  std::vector<std::string> hints;
  const double source_max = m.encoder_max_bps * WireShare(m);
  const double above = ShareAbove(m, source_max);
  if (m.encoder_max_bps > 0 && above > kMostly)
    hints.push_back(
        Text("for %.0f %% of the time a link carried more than the source can use: "
             "at its finest step it needs %.1f Mbit/s",
             100 * above, source_max / 1e6));
  if (n.skipped > n.captured / 10)
    hints.push_back(
        Text("%.0f scans were left out as the target was below the %.1f Mbit/s that "
             "the error bound needs; a larger --max-error needs less",
             static_cast<double>(n.skipped), m.encoder_min_bps * WireShare(m) / 1e6));
  if (n.sent > n.complete + n.captured / 10)
    hints.push_back(
        Text("%.0f scans were sent and did not arrive whole: packets were lost, or "
             "waited too long in the sender's queue",
             static_cast<double>(n.sent - n.complete)));
  return hints;
}

}  // namespace

double WireShare(const Measurements& m) {
  double wire = 0, media = 0, packets = 0, first = 0;
  for (const LinkPacket& p : m.packets) wire += static_cast<double>(p.size);
  for (const auto& [id, scan] : m.ledger.scans())
    for (const SliceLife& s : scan)
      if (s.received > 0) media += static_cast<double>(s.bytes);
  for (const nlohmann::json& link : LinkStats(m)) {
    packets += link.value("packets-sent", 0.0);
    first += link.value("packets-first", 0.0);
  }
  if (packets > 0) wire *= first / packets;
  return media > 0 ? std::clamp(wire / media, 1.0, 1.5) : 1;
}

link::OracleResult AskOracle(const Measurements& m, double media_bps) {
  const ScanCounts n = m.ledger.Count();
  link::OracleConfig config;
  config.rate = DataRate::BitsPerSecond(media_bps * WireShare(m));
  config.duration = FromSeconds(m.ran_s);
  config.max_age = kMaxAge;
  config.rtt = FromSeconds(m.options.rtt_ms / 1e3);
  if (!m.ledger.scans().empty())
    config.slices_per_scan = static_cast<std::uint32_t>(
        std::max<std::size_t>(1, m.ledger.scans().begin()->second.size()));
  config.scans_per_second =
      m.ran_s > 0 ? std::max(1.0, std::round(static_cast<double>(n.captured) / m.ran_s)) : 0;
  const auto links = CapacitiesOf(m.options);
  return links.size() == 1 ? link::AskOracle(links.front(), config)
                           : link::AskOracleOfLinks(links, config);
}

Verdict Judge(const Measurements& m) {
  const ScanCounts n = m.ledger.Count();
  Verdict v;
  if (n.captured == 0) return {Verdict::Level::kPoor, "no scan was captured", {}};
  const auto captured = static_cast<double>(n.captured);
  // The oracle counts the scans at the start and at the end of the run slightly differently, so its
  // number may exceed `captured`.
  double possible = captured;
  if (m.encoder_min_bps > 0)
    possible = std::min(captured, static_cast<double>(AskOracle(m, m.encoder_min_bps).complete));
  const double share = possible > 0 ? static_cast<double>(n.complete) / possible : 1;
  v.level = share >= kUseful      ? Verdict::Level::kUseful
            : share >= kOfSomeUse ? Verdict::Level::kReduced
                                  : Verdict::Level::kPoor;
  static constexpr const char* kWords[] = {"useful", "reduced", "of little use"};
  v.text = Text("%s: %.0f of %.0f scans arrived whole; a sender that knew the link%s: %.0f",
                kWords[static_cast<int>(v.level)], static_cast<double>(n.complete), captured,
                m.options.links > 1 ? "s" : "", possible);
  v.hints = Hints(m, n);
  return v;
}

}  // namespace lidar::demo
