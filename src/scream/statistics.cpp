// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/statistics.h"

#include <cstddef>

namespace lidar::scream {

const char* ToString(EcnState state) {
  constexpr const char* kNames[] = {"off", "testing", "capable", "bleached", "silent"};
  return kNames[static_cast<std::size_t>(state)];
}

const char* ToString(RateReason reason) {
  constexpr const char* kNames[] = {"start", "increase",      "ce",         "loss",
                                    "delay", "capacity-drop", "no-feedback"};
  return kNames[static_cast<std::size_t>(reason)];
}

}  // namespace lidar::scream
