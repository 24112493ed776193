// SPDX-License-Identifier: LGPL-2.1-or-later
// Draft section "Media Rate Control": the target bitrate from window and round trip.
#pragma once
#include <algorithm>

#include "src/scream/parameters.h"

namespace lidar::scream {

struct MediaRateInput {
  DataSize ref_wnd;
  double ref_wnd_ratio = 0;
  Duration s_rtt{0};
  /// rate_adjust_factor + frame_size_dev
  double queue_compensation = 0;
};

/// Returns the bitrate without the limits TARGET_BITRATE_MIN and TARGET_BITRATE_MAX.
inline DataRate TargetBitrate(const Parameters& p, const MediaRateInput& in) {
  double scale = 1 - std::clamp(in.ref_wnd_ratio - 0.1, 0.0, 0.2);
  scale *= p.mss / (p.mss + p.packet_overhead);
  scale /= p.target_rate_divisor + in.queue_compensation;
  return in.ref_wnd / in.s_rtt * scale;
}

/// Returns the window whose target is `rate`, for the start that the draft leaves open.
inline DataSize WindowFor(const Parameters& p, DataRate rate, Duration s_rtt) {
  return rate * s_rtt * p.target_rate_divisor * ((p.mss + p.packet_overhead) / p.mss);
}

}  // namespace lidar::scream
