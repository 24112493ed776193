// SPDX-License-Identifier: LGPL-2.1-or-later
// Statistics that a bond adds to those of a link's screamtx.
#pragma once
#include <gst/gst.h>

#include <string>

#include "src/bonding/scheduler.h"

namespace lidar::gst {

struct BondLinkStats {
  std::string link;  // as in bonding-addresses
  bonding::LinkCounters counters;
  bool usable = true;
  bool in_gap = false;
  bool has_reported = false;
  guint bottleneck = 0;
};

void AddLinkStats(const BondLinkStats& stats, GstStructure* out);

}  // namespace lidar::gst
