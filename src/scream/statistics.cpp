// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/statistics.h"

namespace lidar::scream {

const char* ToString(EcnState state) {
  switch (state) {
    case EcnState::kOff:
      return "off";
    case EcnState::kTesting:
      return "testing";
    case EcnState::kCapable:
      return "capable";
    case EcnState::kBleached:
      return "bleached";
    case EcnState::kSilent:
      return "silent";
  }
  return "";
}

const char* ToString(RateReason reason) {
  switch (reason) {
    case RateReason::kStart:
      return "start";
    case RateReason::kIncrease:
      return "increase";
    case RateReason::kCe:
      return "ce";
    case RateReason::kLoss:
      return "loss";
    case RateReason::kDelay:
      return "delay";
    case RateReason::kDrop:
      return "capacity-drop";
    case RateReason::kTimeout:
      return "no-feedback";
  }
  return "";
}

}  // namespace lidar::scream
