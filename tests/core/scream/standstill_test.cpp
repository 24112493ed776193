// SPDX-License-Identifier: LGPL-2.1-or-later
// Tests a link that carries nothing for some time, and other events during that time.
#include <gtest/gtest.h>

#include "src/sim/scenarios.h"
#include "src/sim/simulated_time.h"

namespace lidar::scream::test {
namespace {

constexpr Duration kFrom = 15s;

/// Returns a link of 8 Mbit/s with an RTT of 40 ms that carries nothing for `length` from 15 s on.
/// The flow has `sources` sources, each with 50 frames per second.
Scenario Standing(Duration length, std::size_t sources = 1) {
  Scenario s = *FindScenario("frames_8M_rtt40", Parameters());
  s.config.forward.capacity.AddOutage(kFrom, kFrom + length);
  s.config.duration = kFrom + length + 5s;
  s.config.flows[0].sources.resize(sources, s.config.flows[0].sources[0]);
  return s;
}

/// Returns the bytes that the sender sent between two times of the run.
std::int64_t Sent(const SimulationResult& run, Duration from, Duration until) {
  const Time origin = run.config.forward.origin;
  std::int64_t bytes = 0;
  for (const PacketLog& p : run.packets)
    if (p.sent >= origin + from && p.sent < origin + until) bytes += p.bytes;
  return bytes;
}

double Utilisation(const SimulationResult& run, Duration from, Duration until) {
  return run.Utilisation(run.config.forward.origin + from, run.config.forward.origin + until);
}

TEST(Standstill, NothingIsBegunInItByASourceThatLeavesItsWindowUnused) {
  Scenario s = Standing(1s);
  s.config.flows[0].sources[0].stream.max_bitrate = Mbps(2);
  const SimulationResult run = Simulate(s.config);
  // The window stays open for one round trip, and then until the next report is overdue. After
  // that, packets are sent at 50 kbit/s only.
  const DataSize most = Mbps(2) * 140ms + Parameters().rate_pace_min * 1s;
  EXPECT_LE(Sent(run, kFrom, kFrom + 1s), most.bytes());
  EXPECT_GE(Utilisation(run, kFrom + 2s, kFrom + 5s), 0.24) << "of the 25 % that it can use";
}

/// A source that sends 2 Mbit/s probes the link in bursts during the first three seconds.
TEST(Standstill, ClosesTheWindowToProbes) {
  for (Duration from = 2500ms; from < 6s; from += 311ms) {
    Scenario s = Standing(0s);
    s.config.flows[0].sources[0].encoder = [](DataRate) {
      return EncodedFrame{DataSize::Bytes(5000), {}};
    };
    s.config.forward.capacity.AddOutage(from, from + 2s);
    s.config.duration = from + 4s;
    const SimulationResult run = Simulate(s.config);
    const DataSize most = Mbps(2) * 140ms + Parameters().rate_pace_min * 2s;
    EXPECT_LE(Sent(run, from, from + 2s), most.bytes()) << Milliseconds(from);
  }
}

/// The source sends whole scans at 3 Mbit/s, which is also the stream's maximum. The link carries
/// 10 Mbit/s, with short gaps.
TEST(Standstill, LeavesABacklogThatSoonGoesToAStreamAtItsMaximum) {
  Scenario s = *FindScenario("frames_8M_rtt40", Parameters());
  s.config.forward.capacity = link::Capacity::Constant(Mbps(10));
  s.config.duration = 30s;
  for (Duration gap = 5s; gap < s.config.duration; gap += 2s)
    s.config.forward.capacity.AddOutage(gap, gap + 100ms);
  SourceConfig& source = s.config.flows[0].sources[0];
  source.frames_per_second = 10;
  source.encoder = [](DataRate) {
    return EncodedFrame{Mbps(3) * 100ms, EncoderBounds{Mbps(3), Mbps(3)}};
  };
  const SimulationResult run = Simulate(s.config);
  const Time origin = run.config.forward.origin;
  EXPECT_LE(run.QueueDelay(origin + 2s, origin + 4900ms).p95, 5) << "no scan leaves in a burst";
  EXPECT_LE(Summarise(run.flows[0].frame_latency_ms).p95, 150);
}

TEST(Standstill, OfMinutesCostsTheTimeItTakes) {
  for (const std::size_t sources : {1U, 2U}) {
    const SimulationResult run = Simulate(Standing(180s, sources).config);
    EXPECT_LE(Sent(run, kFrom + 10s, kFrom + 180s) * 8 / 170, 51e3) << "RATE_PACE_MIN";
    EXPECT_GT(Sent(run, kFrom + 10s, kFrom + 180s), 0) << "or nobody knows when it ends";
    EXPECT_GE(Utilisation(run, kFrom + 181s, kFrom + 184s), 0.7);
  }
}

TEST(Standstill, InWhichOneSourceStopsLeavesTheLinkToTheOther) {
  Scenario s = Standing(500ms, 2);
  s.config.flows[0].sources[0].stop_at = kFrom + 100ms;
  const SimulationResult run = Simulate(s.config);
  const Time origin = run.config.forward.origin;
  const auto other = run.DeliveredBytes(origin + kFrom + 2s, origin + kFrom + 5s, 0, 1);
  EXPECT_GE(static_cast<double>(other) * 8 / 3, 0.85 * 8e6);
}

TEST(Standstill, InWhichClocksAreSetIsForgottenWithinASecond) {
  for (const Duration sender : {Duration(-1h), Duration(0h), Duration(1h)}) {
    for (const Duration receiver : {Duration(-1h), Duration(0h), Duration(1h)}) {
      Scenario s = Standing(500ms);
      FlowConfig& flow = s.config.flows[0];
      flow.clock_jump = kFrom + 250ms;
      flow.sender_jump = sender;
      flow.receiver_jump = receiver;
      const SimulationResult run = Simulate(s.config);
      EXPECT_GE(Utilisation(run, kFrom + 1500ms, kFrom + 4500ms), 0.8)
          << Seconds(sender) << " " << Seconds(receiver);
      EXPECT_LT(Milliseconds(run.flows[0].statistics.s_rtt), 60);
    }
  }
}

}  // namespace
}  // namespace lidar::scream::test
