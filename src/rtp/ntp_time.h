// SPDX-License-Identifier: LGPL-2.1-or-later
// Converts capture times to the 64-bit NTP format of RFC 5905, section 6, which packets use.
#pragma once
#include <cstdint>

namespace lidar::rtp {

constexpr std::uint64_t kNtpToUnixSeconds = 2'208'988'800;

/// Converts a time in ns since 1970. FromNtp() returns exactly the same time.
constexpr std::uint64_t ToNtp(std::uint64_t unix_ns) {
  const std::uint64_t seconds = unix_ns / 1'000'000'000 + kNtpToUnixSeconds;
  const std::uint64_t fraction = ((unix_ns % 1'000'000'000) << 32) / 1'000'000'000;
  return seconds << 32 | fraction;
}
/// Converts an NTP time to ns since 1970. A time before 1970 is taken as a time in the next NTP
/// era, which starts in 2036.
constexpr std::uint64_t FromNtp(std::uint64_t ntp) {
  std::uint64_t seconds = ntp >> 32;
  if (seconds < kNtpToUnixSeconds) seconds += std::uint64_t{1} << 32;
  const std::uint64_t fraction = ntp & 0xFFFF'FFFF;
  // ToNtp() rounds down by less than one unit of 0.23 ns, so rounding up here restores the
  // nanosecond.
  const std::uint64_t ns = (fraction * 1'000'000'000 + 0xFFFF'FFFF) >> 32;
  return (seconds - kNtpToUnixSeconds) * 1'000'000'000 + ns;
}

}  // namespace lidar::rtp
