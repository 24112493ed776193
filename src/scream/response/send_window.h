// SPDX-License-Identifier: LGPL-2.1-or-later
// The draft's send window, and what the extension capacity makes of it.
#pragma once
#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"

namespace lidar::scream {

class SendWindow {
 public:
  explicit SendWindow(const Parameters& parameters) : p_(parameters) {}

  void OnSent(Time now) { last_sent_ = now; }
  /// Before the first packet.
  bool unused() const { return last_sent_ == Time{}; }
  /// Bytes in flight at most. With the extension these are few more than the window where marks
  /// work, and none more while packets keep coming back out of a queue. What is unreported comes on
  /// top.
  DataSize Max(Time now, DataSize ref_wnd, const PathModel& path, Duration qdelay_target) const;
  /// When a packet of `size` may leave. A closed window lets one go at RATE_PACE_MIN, so that it
  /// does not wait for ever for feedback that was lost.
  Time Opens(DataSize size, DataSize in_flight, DataSize max) const;

 private:
  const Parameters& p_;
  Time last_sent_{};
};

}  // namespace lidar::scream
