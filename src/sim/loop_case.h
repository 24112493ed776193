// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs of the whole loop of encoder, sender and link over a changing capacity, with their figures.
#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "src/link/capacity.h"
#include "src/link/oracle.h"
#include "src/scream/parameters.h"
#include "src/sim/loop_source.h"
#include "src/sim/simulation.h"

namespace lidar::loop {

struct LoopCase {
  std::string name;
  link::Capacity capacity = link::Capacity::Constant(DataRate::BitsPerSecond(8e6));
  SourceOptions source;
  /// If true, the source sends 50 frames per second, whose sizes follow the target exactly.
  bool frames = false;
  /// If true, a camera is added. Its frames follow the target exactly, with half of the LiDAR's
  /// priority.
  bool camera = false;
  Duration duration = std::chrono::seconds(60);
  Duration rtt = std::chrono::milliseconds(40);
  link::AqmConfig::Kind aqm = link::AqmConfig::Kind::kRamp;
  link::QueueLimit limit;
  scream::Parameters parameters;
};

struct LoopReport {
  // Scans:
  std::uint64_t captured = 0;
  std::uint64_t skipped = 0;  // skipped by the encoder
  std::uint64_t complete = 0;
  /// Complete scans whose slices all arrive within the oracle's max_age.
  std::uint64_t in_time = 0;
  link::OracleResult oracle_at_min;   // for scans of the lowest bitrate that keeps the error bound
  link::OracleResult oracle_at_mean;  // for scans of the bitrate that the encoder sent
  // Slices:
  scream::test::Percentiles capture_to_cloud_ms;
  // Rates on the wire:
  double min_mbps = 0, max_mbps = 0;  // lowest and highest rate of the source
  double encoded_mbps = 0;
  double utilisation = 0;  // relative to what the link can carry and the source can use
  // The network:
  scream::test::Percentiles queue_ms;
  double own_loss = 0;
  /// The time [s] from the end of a gap until the sender fills 80 % of the usable rate for 100 ms.
  scream::test::Percentiles recovery_s;
  std::size_t gaps = 0;

  double OfOracle() const {
    return static_cast<double>(complete) /
           static_cast<double>(std::max<std::uint64_t>(1, oracle_at_min.complete));
  }
};

struct LoopRun {
  LoopReport report;
  scream::test::SimulationResult simulation;
};

LoopRun RunLoop(const LoopCase& loop_case);

/// Returns the same case with another scene. The run starts `n` times 7.33 s later in the trace of
/// the capacity. Runs over drives are chaotic, so that only the mean of several runs is meaningful.
LoopCase Later(LoopCase loop_case, int n);

struct NamedTrace {
  std::string name;
  link::Capacity capacity;
};
/// Returns the traces with regular gaps, and the generated drives.
std::vector<NamedTrace> BuiltInTraces();
/// Reads a file with lines `time_s rate_mbps`. If the file has another form, sets `error` and
/// returns nothing.
std::optional<NamedTrace> ReadTrace(const std::string& path, std::string* error);

}  // namespace lidar::loop
