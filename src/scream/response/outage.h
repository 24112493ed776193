// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension gaps: handles a silent receiver, and the restart after the silence.
#pragma once
#include <algorithm>
#include <optional>
#include <utility>

#include "src/scream/parameters.h"

namespace lidar::scream {

class Outage {
 public:
  explicit Outage(const Parameters& parameters) : p_(parameters) {}

  /// Measures the silence from now on. Call it when the first packet after a pause is sent, and
  /// when packets in flight are given up.
  void Restart(Time now) { last_feedback_ = now; }
  /// Call it while packets are in flight. Returns a smaller window each time that the receiver has
  /// been silent for too long, compared with `s_rtt` and `frame_period`.
  std::optional<DataSize> OnTimer(Time now, DataSize ref_wnd, Duration s_rtt,
                                  Duration frame_period) {
    const Duration expected = 2 * std::max(frame_period, p_.feedback_interval);
    const Duration timeout = 2 * s_rtt + std::max(kOutage, expected);
    if (!p_.extensions.gaps || now - std::max(last_feedback_, last_timeout_) <= timeout)
      return std::nullopt;
    last_timeout_ = now;
    if (!window_before_) window_before_ = ref_wnd;
    return ref_wnd * kBackoff;
  }
  /// Call it when packets are acknowledged. If an outage ends, returns the window for the restart.
  std::optional<DataSize> OnFeedback(Time now) {
    last_feedback_ = now;
    const auto before = std::exchange(window_before_, std::nullopt);
    return before ? std::optional(*before * kRestart) : std::nullopt;
  }

  bool active() const { return window_before_.has_value(); }
  /// Returns the time since the last acknowledgement, or since the first packet that waits for one.
  Duration Quiet(Time now) const { return now - last_feedback_; }
  /// Returns the time without acknowledgements during an outage, or 0 if there is no outage.
  Duration Silence(Time now) const { return active() ? Quiet(now) : Duration{0}; }

 private:
  /// The receiver's silence is an outage only if it exceeds two round trips by at least this time.
  static constexpr Duration kOutage = 200ms;
  static constexpr double kBackoff = 0.5;
  static constexpr double kRestart = 0.5;
  const Parameters& p_;
  Time last_feedback_{};
  Time last_timeout_{};
  std::optional<DataSize> window_before_;
};

}  // namespace lidar::scream
