// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/response/outage.h"

#include <algorithm>
#include <utility>

namespace lidar::scream {
namespace {

/// Silence of the receiver, beyond round trips, that is an outage.
constexpr Duration kOutage = 200ms;
constexpr double kBackoff = 0.5;
constexpr double kRestart = 0.5;

}  // namespace

std::optional<DataSize> Outage::OnTimer(Time now, DataSize ref_wnd, Duration s_rtt,
                                        Duration frame_period) {
  const Duration expected = std::max(2 * frame_period, 2 * p_.feedback_interval);
  const Duration timeout = 2 * s_rtt + std::max(kOutage, expected);
  if (!p_.extensions.gaps) return std::nullopt;
  if (now - std::max(last_feedback_, last_timeout_) <= timeout) return std::nullopt;
  last_timeout_ = now;
  if (!window_before_) window_before_ = ref_wnd;
  return ref_wnd * kBackoff;
}

std::optional<DataSize> Outage::OnFeedback(Time now) {
  last_feedback_ = now;
  const auto before = std::exchange(window_before_, std::nullopt);
  if (!before) return std::nullopt;
  return *before * kRestart;
}

}  // namespace lidar::scream
