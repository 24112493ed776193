// SPDX-License-Identifier: LGPL-2.1-or-later
// The state of scanassembler.
#pragma once
#include <gst/gst.h>

#include <mutex>
#include <optional>

#include "gst/common/latency.h"
#include "gst/common/refs.h"
#include "gst/common/refused_caps.h"
#include "gst/lidar/cloud_info.h"
#include "gst/pointcloud/assembler/deadline_timer.h"
#include "gst/pointcloud/assembler/scan_queue.h"

namespace lidar::gst {

struct AssemblerSettings {
  guint64 max_wait = 20 * GST_MSECOND;
};

struct AssemblerState {
  AssemblerState() { gst_segment_init(&segment, GST_FORMAT_TIME); }
  /// Resets all except the settings and the timer. The mutex must be held.
  void Reset();
  /// The property `stats`; takes the mutex.
  StructurePtr Stats();

  // Guards all members down to `timer`. The sink pad's streaming lock orders the output: the chain
  // function holds it, and the timer takes it before this mutex.
  std::mutex mutex;
  AssemblerSettings settings;
  ScanQueue queue;
  std::optional<CloudInfo> info;  // of the slices
  CapsPtr in_caps;
  guint out_width = 0;  // in the caps sent last; 0: to be sent again
  bool caps_sent = false;
  EventPtr early_segment;           // waits for the caps
  std::optional<Latency> upstream;  // known after the first query
  GstClockTime scan_latency = 0;    // a scan's part of the reported latency, without max-wait
  GstSegment segment;
  DeadlineTimer timer;

  // Only the streaming thread uses these.
  RefusedCaps refused;
  bool missing_meta_reported = false;
};

}  // namespace lidar::gst
