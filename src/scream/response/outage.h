// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension gaps: handles silence of the receiver, and the restart after it.
#pragma once
#include <optional>

#include "src/scream/parameters.h"

namespace lidar::scream {

class Outage {
 public:
  explicit Outage(const Parameters& parameters) : p_(parameters) {}

  /// Silence counts from now: the first packet after a pause leaves, or packets under way are given
  /// up.
  void Restart(Time now) { last_feedback_ = now; }
  /// Call it while packets are in flight. Returns a smaller window each time that the silence is
  /// too long for these round trips and frames.
  std::optional<DataSize> OnTimer(Time now, DataSize ref_wnd, Duration s_rtt,
                                  Duration frame_period);
  /// Packets were acknowledged. Returns the window for the restart if that ends an outage.
  std::optional<DataSize> OnFeedback(Time now);

  bool active() const { return window_before_.has_value(); }
  /// Time since the last acknowledgement, or since the first packet to wait for.
  Duration Quiet(Time now) const { return now - last_feedback_; }
  /// Time without acknowledgements in an outage; 0 without an outage.
  Duration Silence(Time now) const { return active() ? now - last_feedback_ : Duration{0}; }

 private:
  const Parameters& p_;
  Time last_feedback_{};
  Time last_timeout_{};
  std::optional<DataSize> window_before_;
};

}  // namespace lidar::scream
