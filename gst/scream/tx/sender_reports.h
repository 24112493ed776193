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

/// Call it with the element's lock.
class SenderReports {
 public:
  /// Returns the next report as RTCP if it is due. Call it when media leave: a sender without data
  /// has nothing to report.
  std::vector<std::uint8_t> Take(Duration interval, const TxStreams& streams,
                                 const scream::Controller& controller, Time now);

 private:
  std::optional<Time> last_;  // of the last report, or of the first media
};

}  // namespace lidar::gst
