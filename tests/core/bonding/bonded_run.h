// SPDX-License-Identifier: LGPL-2.1-or-later
// A stream over several simulated links: a controller each, the scheduler above them.
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
  Duration receiver_clock{0};  // lead over the sender's clock
  /// The link is reported to the scheduler as unusable in this time of the run.
  Duration unusable_from = Duration::max(), unusable_until = Duration::max();
};

struct RunConfig {
  std::vector<LinkConfig> links;
  /// Each of two links reports what the other one received, from this time of the run on.
  Duration swapped_from = Duration::max();
  /// All links share the first one's queue; only their round trips differ.
  bool one_bottleneck = false;
  /// Competing flows on the first link.
  std::vector<scream::test::TcpConfig> others;
  Duration duration = std::chrono::seconds(60);
  Method method = Method::kAdaptive;
  TargetRule rule = TargetRule::kBetter;
  loop::SourceOptions source;
};

struct RunResult {
  std::uint64_t scans = 0;
  std::uint64_t in_time = 0;        // scans of which each slice is whole 0.2 s after its capture
  std::vector<double> latency_ms;   // of slices that arrive whole, sorted
  std::vector<double> scan_age_ms;  // age of each scan when its last slice is whole; 1e9: never
  std::int64_t media_bytes = 0;     // output of the encoder, headers included
  std::vector<std::int64_t> link_bytes;  // sent on each link
  std::int64_t other_bytes = 0;          // of competing flows, received
  struct Target {
    Duration time;
    DataRate rate;
  };
  std::vector<Target> targets;  // bitrates that the encoder was asked for
  std::vector<LinkCounters> counters;

  double Share() const { return static_cast<double>(in_time) / static_cast<double>(scans); }
  double Latency(double percent) const;
};

RunResult Simulate(const RunConfig& config);

}  // namespace lidar::bonding::test
