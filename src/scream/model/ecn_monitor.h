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
  void Reset() {
    state_ = wanted_ == Ecn::kNotEct ? EcnState::kOff : EcnState::kTesting;
    sent_ = bleached_ = 0;
  }

  void OnSent(Time now, Ecn sent) {
    if (state_ != EcnState::kTesting || sent == Ecn::kNotEct) return;
    if (sent_++ == 0) first_sent_ = now;
  }
  void OnAcked(Ecn sent, Ecn arrived) {
    if (sent == Ecn::kNotEct || codepoint() == Ecn::kNotEct) return;
    if (arrived != Ecn::kNotEct) {
      state_ = EcnState::kCapable;
      bleached_ = 0;
    } else if (++bleached_ >= kBleachedPackets) {
      state_ = EcnState::kBleached;
    }
    sent_ = 0;  // an acknowledgement ends the silence
  }
  void OnTimer(Time now) {
    if (state_ == EcnState::kTesting && sent_ >= kSilentPackets && now - first_sent_ >= kSilence)
      state_ = EcnState::kSilent;
  }

  Ecn codepoint() const {
    return state_ == EcnState::kTesting || state_ == EcnState::kCapable ? wanted_ : Ecn::kNotEct;
  }
  EcnState state() const { return state_; }

 private:
  /// Number of packets without their codepoint that cannot be chance.
  static constexpr int kBleachedPackets = 20;
  /// Number of unacknowledged packets, and time, after which ECN may be the cause of silence.
  static constexpr int kSilentPackets = 10;
  static constexpr Duration kSilence = 2s;
  Ecn wanted_;
  EcnState state_ = EcnState::kOff;
  int sent_ = 0;
  Time first_sent_{};
  int bleached_ = 0;
};

}  // namespace lidar::scream
