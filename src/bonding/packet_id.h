// SPDX-License-Identifier: LGPL-2.1-or-later
// Identifiers of links and packets.
#pragma once
#include <bitset>
#include <cstddef>
#include <cstdint>

namespace lidar::bonding {

constexpr std::size_t kMaxLinks = 4;
using LinkSet = std::bitset<kMaxLinks>;

/// Identifies an RTP packet and all its copies.
struct PacketId {
  std::uint32_t ssrc = 0;
  std::uint16_t seq = 0;

  std::uint64_t key() const { return std::uint64_t{ssrc} << 16 | seq; }
  friend bool operator==(PacketId a, PacketId b) { return a.key() == b.key(); }
};

}  // namespace lidar::bonding
