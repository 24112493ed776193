// SPDX-License-Identifier: LGPL-2.1-or-later
// The draft's send window, and its limits by the extension capacity.
#pragma once
#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"

namespace lidar::scream {

class SendWindow {
 public:
  explicit SendWindow(const Parameters& parameters) : p_(parameters) {}

  void OnSent(Time now) { last_sent_ = now; }
  /// Returns true before the first packet.
  bool unused() const { return last_sent_ == Time{}; }
  /// Returns the most bytes in flight. With the extension they exceed the window slightly if marks
  /// work, and not at all while packets keep coming out of a queue. Unreported bytes are added.
  DataSize Max(Time now, DataSize ref_wnd, const PathModel& path, Duration qdelay_target) const;
  /// Returns when a packet of `size` may leave. A closed window passes one at RATE_PACE_MIN, so
  /// that lost feedback cannot stop the sender.
  Time Opens(DataSize size, DataSize in_flight, DataSize max) const;

 private:
  const Parameters& p_;
  Time last_sent_{};
};

}  // namespace lidar::scream
