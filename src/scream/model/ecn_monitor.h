// SPDX-License-Identifier: LGPL-2.1-or-later
// Checks what the path does to our ECN codepoint. Falls back to Not-ECT if the path does not keep
// it.
#pragma once
#include "src/scream/parameters.h"
#include "src/scream/statistics.h"

namespace lidar::scream {

/// Bleached: packets sent as ECT arrive as Not-ECT. Silent: no ECT packet was ever acknowledged.
/// Both states last until Reset() after a change of route.
class EcnMonitor {
 public:
  explicit EcnMonitor(Ecn wanted) : wanted_(wanted) { Reset(); }
  void Reset();

  void OnSent(Time now, Ecn sent);
  void OnAcked(Ecn sent, Ecn arrived);
  /// Checks for silence.
  void OnTimer(Time now);

  Ecn codepoint() const;
  EcnState state() const { return state_; }

 private:
  Ecn wanted_;
  EcnState state_ = EcnState::kOff;
  int sent_ = 0;
  Time first_sent_{};
  int bleached_ = 0;
};

}  // namespace lidar::scream
