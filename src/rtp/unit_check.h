// SPDX-License-Identifier: LGPL-2.1-or-later
// Detects whether a stream of packets contains complete slices, without keeping the slices.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/rtp/payload_header.h"

namespace lidar::rtp {

/// Checks the packets of an SSRC whose sender is not accepted yet. Collects the packets of one unit
/// at a time, in order. After a lost packet it waits for the next unit.
class UnitCheck {
 public:
  /// The longest unit that is checked. Longer units are ignored.
  static constexpr std::size_t kMaxBytes = std::size_t{1} << 18;

  /// Returns true if the packet completes a slice whose length and CRC-32 are right.
  bool Push(std::uint16_t sequence, ByteView payload);

 private:
  bool PushUnit(std::uint16_t sequence, const Unit& unit);

  std::optional<Unit> first_;  // its `body` is not used; see bytes_
  std::uint16_t next_sequence_ = 0;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace lidar::rtp
