// SPDX-License-Identifier: LGPL-2.1-or-later
// The names under which screamtx shows its statistics.
#pragma once
#include <gst/gst.h>

#include <string>

#include "gst/common/refs.h"
#include "src/scream/statistics.h"
#include "src/scream/stream_config.h"

namespace lidar::gst {

struct StreamCounters {
  guint64 packets_queued = 0;
  guint64 frames_dropped = 0;
  guint64 malformed = 0;
};

/// Statistics of a stream, from the controller and from screamtx.
struct ShownStream {
  scream::StreamStatistics core;
  scream::StreamConfig config;
  StreamCounters own;
  std::string pad;
  guint ssrc = 0;
  guint encoder_bps = 0;
};

StructurePtr ShowStream(const ShownStream& stream);
StructurePtr ShowController(const scream::Statistics& statistics);

}  // namespace lidar::gst
