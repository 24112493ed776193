// SPDX-License-Identifier: LGPL-2.1-or-later
// Checks what the path does to our ECN codepoint. If the path does not keep the codepoint, the
// sender falls back to Not-ECT.
#pragma once
#include "src/scream/parameters.h"
#include "src/scream/statistics.h"

namespace lidar::scream {

/// The state is kBleached if packets that were sent as ECT arrive as Not-ECT. It is kSilent if
/// Not-ECT packets are acknowledged but ECT packets are not. Both states last until Reset(), which
/// follows a change of the route. If no packet is acknowledged, the cause may be ECN or a missing
/// receiver. To find the cause, packets are then sent as ECT and as Not-ECT alternately.
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
    // A capable path is tested, too, because a new route may drop ECT packets, and then no report
    // arrives that would show the change of the route.
    if (Tries() && sent_ >= kSilentPackets && now - first_sent_ >= kSilence) takes_turns_ = true;
  }

  Ecn codepoint() const { return Tries() && !plain_next_ ? wanted_ : Ecn::kNotEct; }
  EcnState state() const { return state_; }

 private:
  bool Tries() const { return state_ == EcnState::kTesting || state_ == EcnState::kCapable; }

  /// The number of packets that arrive in a row without their codepoint and thus exclude chance.
  static constexpr int kBleachedPackets = 20;
  /// ECN may be the cause of silence if this many packets were sent and none is acknowledged for
  /// kSilence. ECN is the cause if this many Not-ECT packets are then acknowledged.
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
