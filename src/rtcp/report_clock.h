// SPDX-License-Identifier: LGPL-2.1-or-later
// The receiver's clock in report timestamps, which are 32-bit counts of 1/65536 s that wrap.
#pragma once
#include <cstdint>

#include "src/base/sequence.h"
#include "src/base/time.h"

namespace lidar::rtcp {

/// Conversions are exact, so that the wrap of timestamps after 18 hours causes no error.
class ReportClock {
 public:
  static std::uint32_t ToTimestamp(Time t) {
    const std::int64_t ns = t.time_since_epoch().count();
    const std::int64_t s = ns / kSecond;
    return static_cast<std::uint32_t>(s * 65536 + ns % kSecond * 65536 / kSecond);
  }
  /// Converts a timestamp to a time that does not wrap. The first timestamp sets the epoch.
  Time Unwrap(std::uint32_t timestamp) {
    const std::int64_t units = unwrapper_.Unwrap(timestamp);
    const std::int64_t s = units / 65536;
    return Time{Duration{s * kSecond + units % 65536 * kSecond / 65536}};
  }

 private:
  static constexpr std::int64_t kSecond = 1'000'000'000;
  SequenceUnwrapper<std::uint32_t> unwrapper_;
};

}  // namespace lidar::rtcp
