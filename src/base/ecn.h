// SPDX-License-Identifier: LGPL-2.1-or-later
// The two ECN bits of the IP header.
#pragma once
#include <cstdint>

namespace lidar {

/// The values of the two bits, in the IP header and in RFC 8888.
enum class Ecn : std::uint8_t { kNotEct = 0, kEct1 = 1, kEct0 = 2, kCe = 3 };

}  // namespace lidar
