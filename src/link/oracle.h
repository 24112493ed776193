// SPDX-License-Identifier: LGPL-2.1-or-later
// The upper bound for real senders: what a sender that knows a link in advance can deliver.
#pragma once
#include <cstdint>
#include <vector>

#include "src/base/time.h"
#include "src/base/units.h"
#include "src/link/capacity.h"

namespace lidar::link {

/// The stream that the oracle sends: scans of equal slices at an even pace.
struct OracleConfig {
  DataRate rate;  // of all slices, including headers
  Duration duration = std::chrono::seconds{60};
  double share = 1;  // fraction of the capacity that the stream gets
  /// A scan whose first slice has waited longer than this is dropped as a whole, unless it is the
  /// newest scan.
  Duration max_age = std::chrono::milliseconds{200};
  Duration rtt = std::chrono::milliseconds{40};
  /// A sender over several links sends to each link no faster than the link carried this long ago.
  /// If the value is 0, the sender knows the links in advance.
  Duration known_after{0};
  std::uint32_t slices_per_scan = 8;
  double scans_per_second = 10;
};

struct OracleResult {
  std::uint64_t scans = 0;
  std::uint64_t complete = 0;
  std::vector<double> latency_ms;  // of the slices that arrive, including propagation, sorted

  double Latency(double percent) const;
};

OracleResult AskOracle(const Capacity& capacity, const OracleConfig& config);

/// The links that carry a slice, if the sender has several links.
enum class Bonding {
  kWhereWholeFirst,
  kOnEach,  // on each link that can deliver it in time
};
/// Returns the upper bound for several links. A slice that no link can deliver within `max_age` is
/// dropped, and a scan counts if all its slices arrive. AskOracle() differs for a single link,
/// because it finishes each scan of which a part was sent.
OracleResult AskOracleOfLinks(const std::vector<Capacity>& links, const OracleConfig& config,
                              Bonding bonding = Bonding::kWhereWholeFirst);

}  // namespace lidar::link
