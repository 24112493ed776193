// SPDX-License-Identifier: LGPL-2.1-or-later
// When screamtx tells the receiver how it sees the path, and what.
#pragma once
#include <gst/gst.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/time.h"

namespace lidar::gst {

struct TxState;

/// Called with the element's lock.
class SenderReports {
 public:
  /// The next one as RTCP, where one is due. To be asked with media that leaves: a sender that has
  /// nothing to send has nothing to report.
  std::vector<std::uint8_t> Take(const TxState& state, Time now);

 private:
  std::optional<Time> last_;  // or when media left first
};

}  // namespace lidar::gst
