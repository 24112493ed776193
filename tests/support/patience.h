// SPDX-License-Identifier: LGPL-2.1-or-later
// Time limits of tests for events that must happen.
#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <thread>

namespace lidar::test {

/// A busy machine stays below this: only a failure takes so long.
constexpr std::chrono::seconds kPatience{180};
constexpr std::int64_t kPatience_us = kPatience / std::chrono::microseconds(1);
constexpr std::int64_t kPatience_ns = kPatience / std::chrono::nanoseconds(1);

/// Returns true once `holds` returns true, and false after kPatience.
inline bool Eventually(const std::function<bool()>& holds) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace lidar::test
