// SPDX-License-Identifier: LGPL-2.1-or-later
// Compares the fate of each packet of a fixed load, and the result of a sender that knows the link,
// with golden files.
#include <cmath>

#include "src/link/bottleneck.h"
#include "src/link/gaps.h"
#include "src/link/oracle.h"
#include "tests/support/golden_lines.h"

namespace lidar::link {
namespace {
using namespace std::chrono_literals;
using test::Line;
using test::Lines;
using Kind = AqmConfig::Kind;

const Time kBegin{1000s};

DataRate OfMbps(double mbps) { return DataRate::BitsPerSecond(mbps * 1e6); }

std::string Us(Duration t) {
  return t == Duration::max() ? "never" : std::to_string(std::llround(Seconds(t) * 1e6));
}

/// Sends bursts of packets with each ECN codepoint at twice the capacity of the link. Returns the
/// outcomes.
Lines Played(const std::string& what, BottleneckConfig config) {
  static constexpr const char* kFates[] = {"", "lost", "queue full", "aqm dropped"};
  Lines lines = {"- " + what};
  config.origin = kBegin;
  config.seed = 7;
  Bottleneck link(config);
  std::uint64_t id = 0;
  std::size_t delivered = 0;
  for (Time now = kBegin; now < kBegin + 200ms; now += 5ms) {
    if (now < kBegin + 120ms)
      for (int i = 0; i < 5; ++i, ++id)
        link.Enqueue(now, {DataSize::Bytes(400 + 50 * i), static_cast<Ecn>(id % 4), id});
    for (const Outcome& o : link.Deliver(now)) {
      if (++delivered % 5 != 0 && o.delivered() && !o.duplicate) continue;
      lines.push_back(Line(o.packet.id, ": ", kFates[static_cast<int>(o.fate)], " ecn ",
                           static_cast<int>(o.packet.ecn), " sent ", Us(o.sent - kBegin), " there ",
                           Us(o.arrival - kBegin), " waited ", Us(o.sojourn),
                           o.duplicate ? " again" : ""));
    }
    if (now == kBegin + 100ms)
      lines.push_back(
          Line("queued ", link.queued().bytes(), ", next ", Us(link.NextEventTime() - kBegin)));
  }
  const BottleneckStats& s = link.stats();
  lines.push_back(Line("sent ", s.sent, " delivered ", s.delivered, " lost ", s.lost, " full ",
                       s.queue_full, " dropped ", s.aqm_dropped, " marked ", s.marked,
                       " duplicated ", s.duplicated, " bytes ", s.delivered_size.bytes()));
  return lines;
}

TEST(LinkGolden, Fates) {
  Lines all;
  const auto play = [&](const std::string& what, const BottleneckConfig& config) {
    const Lines lines = Played(what, config);
    all.insert(all.end(), lines.begin(), lines.end());
  };
  BottleneckConfig config;
  config.capacity = Capacity::Constant(OfMbps(3));
  for (const auto& [name, kind] : {std::pair{"none", Kind::kNone}, std::pair{"step", Kind::kStep},
                                   std::pair{"ramp", Kind::kRamp}, std::pair{"pi2", Kind::kPi2},
                                   std::pair{"dualpi2", Kind::kDualPi2}}) {
    config.aqm.kind = kind;
    play(name, config);
  }
  config.aqm.kind = Kind::kPi2;
  config.aqm.pi2.knows_l4s = false;
  play("pi2 without L4S", config);
  config = {};
  config.capacity = Capacity::Steps({OfMbps(3), OfMbps(0), OfMbps(6)}, 40ms);
  config.delay = 20ms;
  config.limit.time = 10ms;
  play("limit in time, gap", config);
  config.limit = {DataSize::Bytes(2500), Duration::max()};
  config.loss = 0.1;
  play("limit in bytes, loss", config);
  config = {};
  config.capacity = Capacity::Constant(OfMbps(20));
  config.path = {3ms, 2ms, 0.1, 7ms, 0.1, 3};
  play("jitter, bursts, reordering, duplicates", config);
  test::ExpectGoldenLines(all, GOLDEN_FOLDER "/fates.txt");
}

TEST(LinkGolden, Capacities) {
  Lines lines;
  const auto note = [&](const std::string& what, const Capacity& c) {
    lines.push_back("- " + what);
    for (const Duration t : {Duration{0}, Duration{999ms}, Duration{1s}, Duration{1500ms},
                             Duration{2s}, Duration{3500ms}, Duration{5s}, Duration{7s}})
      lines.push_back(Line(Us(t), ": ", c.RateAt(t).bits_per_second(), " bit/s until ",
                           Us(c.NextChange(t)), ", 100 kB until ",
                           Us(c.Finish(t, DataSize::Bytes(100'000))), ", in a second ",
                           c.Between(t, t + 1s).bytes()));
    std::string ends;
    for (const Duration end : EndsOfGaps(c, 9s)) ends += " " + Us(end);
    lines.push_back("gaps end" + ends);
  };
  const std::vector<DataRate> rates = {OfMbps(2), OfMbps(0), OfMbps(4)};
  std::string error;
  const char* trace = "# time rate\n0.5 2\n1 0.1 # gap\n\n3 8\n";
  note("constant", Capacity::Constant(OfMbps(1)));
  note("steps", Capacity::Steps(rates, 1s));
  note("steps again", Capacity::Steps(rates, 1s, true));
  note("steps with an outage", Capacity::Steps(rates, 1s, true).AddOutage(3s, 3800ms));
  note("steps from 1.5 s", Capacity::Steps(rates, 1s, true).StartingAt(1500ms));
  note("steps once, from 1.5 s", Capacity::Steps(rates, 1s).StartingAt(1500ms));
  note("trace", *Capacity::ParseTrace(trace, false, &error));
  note("trace again", *Capacity::ParseTrace(trace, true, &error));
  for (const char* wrong : {"", "# 1\n", "1\n", "0 5 6\n", "0 -1\n", "-1 5\n", "0 1\n0 2\n",
                            "1 5\n0 5\n", "0 1000001\n", "0 nan\n", "0 five\n", "inf 5\n"}) {
    error.clear();
    const bool taken = Capacity::ParseTrace(wrong, true, &error).has_value();
    lines.push_back(Line(taken ? "taken" : "refused", ": ", error));
  }
  test::ExpectGoldenLines(lines, GOLDEN_FOLDER "/capacities.txt");
}

TEST(LinkGolden, Oracles) {
  Lines lines;
  const auto note = [&](const std::string& what, const OracleResult& r) {
    lines.push_back(Line(what, ": ", r.complete, " of ", r.scans, ", ", r.latency_ms.size(),
                         " slices, ", r.Latency(0), " ", r.Latency(50), " ", r.Latency(95), " ",
                         r.Latency(100), " ms"));
  };
  const Capacity gaps =
      Capacity::Steps({OfMbps(8), OfMbps(8), OfMbps(0.1), OfMbps(2)}, 500ms, true);
  const Capacity other = gaps.StartingAt(1200ms);
  OracleConfig config;
  config.rate = OfMbps(3);
  config.duration = 20s;
  note("one link", AskOracle(gaps, config));
  note("one of several", AskOracleOfLinks({gaps}, config));
  note("two links", AskOracleOfLinks({gaps, other}, config));
  note("two links, on each", AskOracleOfLinks({gaps, other}, config, Bonding::kOnEach));
  config.known_after = 100ms;
  note("known late", AskOracleOfLinks({gaps, other}, config));
  config.known_after = Duration{0};
  config.share = 0.5;
  note("half", AskOracle(gaps, config));
  note("half of each", AskOracleOfLinks({gaps, other}, config));
  config = {OfMbps(3), 20s, 1, 100ms, 60ms, Duration{0}, 1, 20};
  note("whole scans", AskOracle(gaps, config));
  note("whole scans, two", AskOracleOfLinks({gaps, other}, config));
  std::vector<SentPacket> packets;
  for (int i = 0; i < 4000; ++i)
    packets.push_back({i * 5ms, DataSize::Bytes(i % 330 < 250 ? 300 : 3000)});
  for (const double share : {0.4, 0.8}) {
    std::string after;
    for (const double s : RecoveryAfterGaps(gaps, packets, {20s, OfMbps(5), share}))
      after += Line(" ", s);
    lines.push_back("recovered after" + after);
  }
  test::ExpectGoldenLines(lines, GOLDEN_FOLDER "/oracles.txt");
}

}  // namespace
}  // namespace lidar::link
