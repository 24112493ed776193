// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension adaptive_pacing: pacing headroom that follows the frame period.
#pragma once
#include <algorithm>

#include "src/scream/parameters.h"

namespace lidar::scream {

/// PACKET_PACING_HEADROOM, or so much that a frame leaves `pacing_reserve` before its period ends.
inline double PacingHeadroom(const Parameters& p, Duration frame_period) {
  if (!p.extensions.adaptive_pacing) return p.packet_pacing_headroom;
  const double reserve = std::clamp(Seconds(p.pacing_reserve) / Seconds(frame_period),
                                    p.min_pacing_reserve, p.max_pacing_reserve);
  return 1 / (1 - reserve);
}

}  // namespace lidar::scream
