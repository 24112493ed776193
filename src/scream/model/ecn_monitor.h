// SPDX-License-Identifier: LGPL-2.1-or-later
// Checks what the path does to our ECN codepoint. Falls back to Not-ECT if the path does not keep
// it.
#pragma once
#include "src/scream/parameters.h"
#include "src/scream/statistics.h"

namespace lidar::scream {

/// Bleached: packets sent as ECT arrive as Not-ECT. Silent: Not-ECT packets are acknowledged, ECT
/// packets are not. Both states last until Reset() after a change of route. If nothing is
/// acknowledged, the cause may be ECN or a missing receiver, so packets leave as ECT and Not-ECT by
/// turns.
class EcnMonitor {
 public:
  explicit EcnMonitor(Ecn wanted) : wanted_(wanted) { Reset(); }
  void Reset() {
    state_ = wanted_ == Ecn::kNotEct ? EcnState::kOff : EcnState::kTesting;
    sent_ = bleached_ = plain_acked_ = 0;
    takes_turns_ = plain_next_ = false;
  }

  void OnSent(Time now, Ecn sent) {
    plain_next_ = takes_turns_ && sent != Ecn::kNotEct;
    if (!Tries() || sent == Ecn::kNotEct) return;
    if (sent_++ == 0) first_sent_ = now;
  }
  void OnAcked(Ecn sent, Ecn arrived) {
    if (!Tries()) return;
    if (sent == Ecn::kNotEct) {
      if (takes_turns_ && ++plain_acked_ >= kSilentPackets) state_ = EcnState::kSilent;
      return;
    }
    if (arrived != Ecn::kNotEct) {
      state_ = EcnState::kCapable;
      bleached_ = 0;
    } else if (++bleached_ >= kBleachedPackets) {
      state_ = EcnState::kBleached;
    }
    // An acknowledgement ends the silence.
    sent_ = plain_acked_ = 0;
    takes_turns_ = plain_next_ = false;
  }
  void OnTimer(Time now) {
    // A capable path is tested, too: if a new route drops ECT, no report shows the change of route.
    if (Tries() && sent_ >= kSilentPackets && now - first_sent_ >= kSilence) takes_turns_ = true;
  }

  Ecn codepoint() const { return Tries() && !plain_next_ ? wanted_ : Ecn::kNotEct; }
  EcnState state() const { return state_; }

 private:
  bool Tries() const { return state_ == EcnState::kTesting || state_ == EcnState::kCapable; }

  /// Number of packets without their codepoint that cannot be chance.
  static constexpr int kBleachedPackets = 20;
  /// Number of unacknowledged packets, and time, after which ECN may be the cause of silence. The
  /// same number of acknowledged Not-ECT packets proves it.
  static constexpr int kSilentPackets = 10;
  static constexpr Duration kSilence = 2s;
  Ecn wanted_;
  EcnState state_ = EcnState::kOff;
  int sent_ = 0;
  Time first_sent_{};
  int bleached_ = 0;
  int plain_acked_ = 0;
  bool takes_turns_ = false;
  bool plain_next_ = false;
};

}  // namespace lidar::scream
