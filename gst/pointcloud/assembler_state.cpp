// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/pointcloud/assembler_state.h"

namespace lidar::gst {

void AssemblerState::Reset() {
  upstream.reset();
  queue = ScanQueue();
  info.reset();
  in_caps.reset();
  out_width = 0;
  caps_sent = false;
  early_segment.reset();
  scan_latency = 0;
  gst_segment_init(&segment, GST_FORMAT_TIME);
}

GstStructure* AssemblerState::Stats() {
  std::lock_guard lock(mutex);
  const auto& c = queue.counters();
  return gst_structure_new("application/x-scanassembler-stats", "scans", G_TYPE_UINT64, c.scans,
                           "incomplete", G_TYPE_UINT64, c.incomplete, "late-slices", G_TYPE_UINT64,
                           c.late, "duplicate-slices", G_TYPE_UINT64, c.duplicates,
                           "invalid-slices", G_TYPE_UINT64, c.invalid, nullptr);
}

}  // namespace lidar::gst
