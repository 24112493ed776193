// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/model/ecn_monitor.h"

namespace lidar::scream {
namespace {

/// Not one packet of so many arrived with its codepoint: no accident.
constexpr int kBleachedPackets = 20;
/// Unacknowledged packets, and time, before silence is blamed on ECN.
constexpr int kSilentPackets = 10;
constexpr Duration kSilence = 2s;

}  // namespace

void EcnMonitor::Reset() {
  state_ = wanted_ == Ecn::kNotEct ? EcnState::kOff : EcnState::kTesting;
  sent_ = bleached_ = 0;
}

Ecn EcnMonitor::codepoint() const {
  return state_ == EcnState::kTesting || state_ == EcnState::kCapable ? wanted_ : Ecn::kNotEct;
}

void EcnMonitor::OnSent(Time now, Ecn sent) {
  if (state_ != EcnState::kTesting || sent == Ecn::kNotEct) return;
  if (sent_++ == 0) first_sent_ = now;
}

void EcnMonitor::OnAcked(Ecn sent, Ecn arrived) {
  if (sent == Ecn::kNotEct || codepoint() == Ecn::kNotEct) return;
  if (arrived != Ecn::kNotEct) {
    state_ = EcnState::kCapable;
    bleached_ = 0;
  } else if (++bleached_ >= kBleachedPackets) {
    state_ = EcnState::kBleached;
  }
  sent_ = 0;  // something came back: not silent
}

void EcnMonitor::OnTimer(Time now) {
  if (state_ == EcnState::kTesting && sent_ >= kSilentPackets && now - first_sent_ >= kSilence)
    state_ = EcnState::kSilent;
}

}  // namespace lidar::scream
