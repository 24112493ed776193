// SPDX-License-Identifier: LGPL-2.1-or-later
// The reports of screamtx to the receiver, and their times.
#pragma once
#include <gst/gst.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "gst/scream/tx/stream.h"
#include "src/base/time.h"
#include "src/scream/controller.h"

namespace lidar::gst {

/// Called with the element's lock.
class SenderReports {
 public:
  /// The next one as RTCP, where one is due. To be asked with media that leaves: a sender that has
  /// nothing to send has nothing to report.
  std::vector<std::uint8_t> Take(Duration interval, const TxStreams& streams,
                                 const scream::Controller& controller, Time now);

 private:
  std::optional<Time> last_;  // or when media left first
};

}  // namespace lidar::gst
