// SPDX-License-Identifier: LGPL-2.1-or-later
// Time limits for events that a test waits for.
#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <thread>

namespace lidar::test {

/// The longest time that a test waits for an event that must happen. It is so long that an event
/// does not exceed it even on a busy machine.
constexpr std::chrono::seconds kPatience{180};
constexpr std::int64_t kPatience_us = kPatience / std::chrono::microseconds(1);
constexpr std::int64_t kPatience_ns = kPatience / std::chrono::nanoseconds(1);

/// Waits until `holds` returns true, and returns true. Returns false after kPatience.
inline bool Eventually(const std::function<bool()>& holds) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace lidar::test
