// SPDX-License-Identifier: LGPL-2.1-or-later
// The upper bound for real senders: what a sender that knows a link in advance delivers.
#pragma once
#include <cstdint>
#include <vector>

#include "src/base/time.h"
#include "src/base/units.h"
#include "src/link/capacity.h"

namespace lidar::link {

/// Scans of equal slices at an even pace.
struct OracleConfig {
  DataRate rate;  // of all slices, headers included
  Duration duration = std::chrono::seconds{60};
  double share = 1;  // of the capacity
  /// A scan whose first slice has waited longer is dropped whole, except for the newest scan.
  Duration max_age = std::chrono::milliseconds{200};
  Duration rtt = std::chrono::milliseconds{40};
  /// A sender over several links gives each link no more than the link carried this long ago. With
  /// 0 the sender knows the links in advance.
  Duration known_after{0};
  std::uint32_t slices_per_scan = 8;
  double scans_per_second = 10;
};

struct OracleResult {
  std::uint64_t scans = 0;
  std::uint64_t complete = 0;
  std::vector<double> latency_ms;  // of the slices that arrive, with propagation, sorted

  double Latency(double percent) const;
};

OracleResult AskOracle(const Capacity& capacity, const OracleConfig& config);

/// The links that carry a slice if the sender has several.
enum class Bonding {
  kWhereWholeFirst,
  kOnEach,  // on each link that can deliver it in time
};
/// The bound over several links: a slice that no link delivers within `max_age` is dropped, and a
/// scan counts if all its slices arrive. AskOracle() differs for a single link: it finishes each
/// scan that has begun.
OracleResult AskOracleOfLinks(const std::vector<Capacity>& links, const OracleConfig& config,
                              Bonding bonding = Bonding::kWhereWholeFirst);

}  // namespace lidar::link
