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
  /// Resets everything except the settings and the timer. The caller must hold the mutex.
  void Reset();
  /// Returns the property `stats`. Locks the mutex.
  StructurePtr Stats();

  // Guards the members from `settings` to `timer`. The order of the output is protected by the
  // stream lock of the sink pad, which the chain function holds. The timer's thread locks the
  // stream lock before this mutex.
  std::mutex mutex;
  AssemblerSettings settings;
  ScanQueue queue;
  std::optional<CloudInfo> info;  // describes the slices
  CapsPtr in_caps;
  guint out_width = 0;  // width in the caps that were sent last; 0: caps must be sent again
  bool caps_sent = false;
  EventPtr early_segment;           // a segment that arrived before the caps were sent
  std::optional<Latency> upstream;  // known after the first query
  GstClockTime scan_latency = 0;    // latency of a whole scan, without max-wait
  GstSegment segment;
  DeadlineTimer timer;

  // The members below are used by the streaming thread only.
  RefusedCaps refused;
  bool missing_meta_reported = false;
};

}  // namespace lidar::gst
