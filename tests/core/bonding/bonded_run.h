// SPDX-License-Identifier: LGPL-2.1-or-later
// Simulates a stream over several links. Each link has a controller, and the scheduler distributes
// the packets.
#pragma once
#include <functional>
#include <vector>

#include "src/bonding/scheduler.h"
#include "src/link/bottleneck.h"
#include "src/sim/loop_source.h"

namespace lidar::bonding::test {

struct LinkConfig {
  link::Capacity capacity = link::Capacity::Constant(DataRate::BitsPerSecond(8e6));
  Duration rtt = std::chrono::milliseconds(40);
  double loss = 0;
  link::AqmConfig aqm{};
  link::QueueLimit limit{};
  link::PathConfig path{};
  Duration receiver_clock{0};  // how much it is ahead of the sender's clock
  /// The time of the run in which the scheduler is told that the link is unusable.
  Duration unusable_from = Duration::max(), unusable_until = Duration::max();
};

struct RunConfig {
  std::vector<LinkConfig> links;
  /// The time of the run from which each of two links reports the packets that the other link
  /// received.
  Duration swapped_from = Duration::max();
  /// If true, all links share the queue of the first link and differ only in their round trips.
  bool one_bottleneck = false;
  /// The flows that compete with the first link.
  std::vector<scream::test::TcpConfig> others;
  Duration duration = std::chrono::seconds(60);
  Method method = Method::kAdaptive;
  TargetRule rule = TargetRule::kBetter;
  loop::SourceOptions source;
};

struct RunResult {
  std::uint64_t scans = 0;
  // The scans whose slices were all complete 0.2 s after their capture.
  std::uint64_t in_time = 0;
  std::vector<double> latency_ms;  // of each slice that arrived completely, sorted
  // The age of each scan when its last slice was complete, or 1e9 if it never was.
  std::vector<double> scan_age_ms;
  std::int64_t media_bytes = 0;          // the output of the encoder, including headers
  std::vector<std::int64_t> link_bytes;  // sent over each link
  std::int64_t other_bytes = 0;          // received by the competing flows
  struct Target {
    Duration time;
    DataRate rate;
  };
  std::vector<Target> targets;  // the bitrates that were requested from the encoder
  std::vector<LinkCounters> counters;

  double Share() const { return static_cast<double>(in_time) / static_cast<double>(scans); }
  double Latency(double percent) const;
};

RunResult Simulate(const RunConfig& config);

}  // namespace lidar::bonding::test
