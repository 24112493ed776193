// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/pointcloud/assembler/assembler_state.h"

#include "gst/common/stats.h"

namespace lidar::gst {

void AssemblerState::Reset() {
  upstream.reset();
  queue = ScanQueue();
  info.reset();
  in_caps.reset();
  out_width = 0;
  caps_sent = false;
  early_segment.reset();
  refused.Reset();
  missing_meta_reported = false;
  scan_latency = 0;
  gst_segment_init(&segment, GST_FORMAT_TIME);
}

StructurePtr AssemblerState::Stats() {
  using Counters = ScanCounters;
  static const std::array<Stat<Counters>, 5> kStats = {{
      {"scans", &Counters::scans},
      {"incomplete", &Counters::incomplete},
      {"late-slices", &Counters::late},
      {"duplicate-slices", &Counters::duplicates},
      {"invalid-slices", &Counters::invalid},
  }};
  std::lock_guard lock(mutex);
  return ToStructure("application/x-scanassembler-stats", kStats, queue.counters());
}

}  // namespace lidar::gst
