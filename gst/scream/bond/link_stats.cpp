// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/scream/bond/link_stats.h"

#include "gst/common/stats.h"

namespace lidar::gst {
namespace {

using Link = BondLinkStats;
using C = bonding::LinkCounters;

}  // namespace

void AddLinkStats(const BondLinkStats& stats, GstStructure* out) {
  static const std::array<Stat<Link>, 9> kStats = {{
      {"link", &Link::link},
      {"usable", &Link::usable},
      {"in-gap", &Link::in_gap},
      {"link-gaps", At<&Link::counters, &C::gaps>},
      {"packets-first", At<&Link::counters, &C::packets>},
      {"packets-copies", At<&Link::counters, &C::copies>},
      {"copies-cancelled", At<&Link::counters, &C::cancelled>},
      {"packets-saved", At<&Link::counters, &C::saved>},
      {"bottleneck", &Link::bottleneck},
  }};
  AddStats(out, kStats, stats);
}

}  // namespace lidar::gst
