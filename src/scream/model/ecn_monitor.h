// SPDX-License-Identifier: LGPL-2.1-or-later
// Watches what the path does to our ECN codepoint and falls back to Not-ECT where it is not kept.
#pragma once
#include "src/scream/parameters.h"
#include "src/scream/statistics.h"

namespace lidar::scream {

/// Bleached: packets sent with ECT arrive as Not-ECT. Silent: from the start nothing that carried
/// ECT is acknowledged. Both last until Reset(), which a new route calls for.
class EcnMonitor {
 public:
  explicit EcnMonitor(Ecn wanted) : wanted_(wanted) { Reset(); }
  void Reset();

  void OnSent(Time now, Ecn sent);
  void OnAcked(Ecn sent, Ecn arrived);
  /// Looks for silence.
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
