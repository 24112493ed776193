// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/bond/link_stats.h"

#include "gst/common/stats.h"

namespace lidar::gst {
namespace {

using S = BondLinkStats;
using C = bonding::LinkCounters;

}  // namespace

void AddLinkStats(const BondLinkStats& stats, GstStructure* out) {
  static const std::array<Stat<S>, 9> kStats = {{
      {"link", &S::link},
      {"usable", &S::usable},
      {"in-gap", &S::in_gap},
      {"link-gaps", At<&S::counters, &C::gaps>},
      {"packets-first", At<&S::counters, &C::packets>},
      {"packets-copies", At<&S::counters, &C::copies>},
      {"copies-cancelled", At<&S::counters, &C::cancelled>},
      {"packets-saved", At<&S::counters, &C::saved>},
      {"bottleneck", &S::bottleneck},
  }};
  AddStats(out, kStats, stats);
}

}  // namespace lidar::gst
