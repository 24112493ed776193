// SPDX-License-Identifier: LGPL-2.1-or-later
// What ouster_src counts, and its property `stats`.
#pragma once
#include <gst/gst.h>

#include <array>

#include "gst/common/stats.h"
#include "src/ouster/sensor_stream.h"

namespace lidar::gst {

struct Counters {
  ouster::BatcherStats batcher;
  ouster::StreamStats stream;
  guint64 kernel_drops = 0;
  guint reconnects = 0;
  guint receive_buffer = 0;  // bytes
  bool synchronised = false;
};

extern const std::array<Stat<Counters>, 16> kOusterStats;

}  // namespace lidar::gst
