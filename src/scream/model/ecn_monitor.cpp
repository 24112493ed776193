// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/model/ecn_monitor.h"

namespace lidar::scream {
namespace {

/// Number of packets without their codepoint that cannot be chance.
constexpr int kBleachedPackets = 20;
/// Number of unacknowledged packets, and time, after which ECN may be the cause of silence.
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
  sent_ = 0;  // an acknowledgement ends the silence
}

void EcnMonitor::OnTimer(Time now) {
  if (state_ == EcnState::kTesting && sent_ >= kSilentPackets && now - first_sent_ >= kSilence)
    state_ = EcnState::kSilent;
}

}  // namespace lidar::scream
