// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension gaps: silence of the receiver, and the way back after it.
#pragma once
#include <optional>

#include "src/scream/parameters.h"

namespace lidar::scream {

class Outage {
 public:
  explicit Outage(const Parameters& parameters) : p_(parameters) {}

  /// Silence counts from here: the first packet after a pause leaves, or what was on the way is
  /// not waited for any more.
  void Restart(Time now) { last_feedback_ = now; }
  /// While packets are in flight. Returns the smaller window to go on with, once each time that
  /// the silence is too long for these round trips and frames.
  std::optional<DataSize> OnTimer(Time now, DataSize ref_wnd, Duration s_rtt,
                                  Duration frame_period);
  /// Packets were acknowledged. Returns the window to restart from where that ends an outage.
  std::optional<DataSize> OnFeedback(Time now);

  bool active() const { return window_before_.has_value(); }
  /// Since the last acknowledgement, or since there was anything to wait for.
  Duration Quiet(Time now) const { return now - last_feedback_; }
  /// How long nothing has come back; 0 where there is no outage.
  Duration Silence(Time now) const { return active() ? now - last_feedback_ : Duration{0}; }

 private:
  const Parameters& p_;
  Time last_feedback_{};
  Time last_timeout_{};
  std::optional<DataSize> window_before_;
};

}  // namespace lidar::scream
