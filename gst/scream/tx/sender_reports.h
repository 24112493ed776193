// SPDX-License-Identifier: LGPL-2.1-or-later
// The reports of screamtx to the receiver, and their schedule.
#pragma once
#include <gst/gst.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "gst/scream/tx/stream.h"
#include "src/base/time.h"
#include "src/scream/controller.h"

namespace lidar::gst {

/// Call it with the element's lock held.
class SenderReports {
 public:
  /// Returns the next report as RTCP, or nothing if no report is due. Call it only when media
  /// packets are sent, because a sender without data has nothing to report.
  std::vector<std::uint8_t> Take(Duration interval, const TxStreams& streams,
                                 const scream::Controller& controller, Time now);

 private:
  std::optional<Time> last_;  // time of the last report, or of the first media packet
};

}  // namespace lidar::gst
