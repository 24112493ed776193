// SPDX-License-Identifier: LGPL-2.1-or-later
// Capture times on the wire: the 64-bit NTP format of RFC 5905, section 6.
#pragma once
#include <cstdint>

namespace lidar::rtp {

constexpr std::uint64_t kNtpToUnixSeconds = 2'208'988'800;

/// `unix_ns` is since 1970. FromNtp() gives back the same nanosecond.
constexpr std::uint64_t ToNtp(std::uint64_t unix_ns) {
  const std::uint64_t seconds = unix_ns / 1'000'000'000 + kNtpToUnixSeconds;
  const std::uint64_t fraction = ((unix_ns % 1'000'000'000) << 32) / 1'000'000'000;
  return seconds << 32 | fraction;
}
/// Times before 1970 are read as those of the next era, which starts in 2036.
constexpr std::uint64_t FromNtp(std::uint64_t ntp) {
  std::uint64_t seconds = ntp >> 32;
  if (seconds < kNtpToUnixSeconds) seconds += std::uint64_t{1} << 32;
  const std::uint64_t fraction = ntp & 0xFFFF'FFFF;
  // ToNtp rounds down by less than one unit of 0.23 ns, so rounding up restores the nanosecond.
  const std::uint64_t ns = (fraction * 1'000'000'000 + 0xFFFF'FFFF) >> 32;
  return (seconds - kNtpToUnixSeconds) * 1'000'000'000 + ns;
}

}  // namespace lidar::rtp
