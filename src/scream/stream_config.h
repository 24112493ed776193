// SPDX-License-Identifier: LGPL-2.1-or-later
// Streams and their packets, as the caller describes them.
#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>

#include "src/base/ecn.h"
#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::scream {

/// Identifies a stream of a controller. An id is not used again after RemoveStream().
using StreamId = int;

struct StreamConfig {
  double priority = 1;  ///< weight of the stream's share, > 0
  DataRate min_bitrate = DataRate::BitsPerSecond(100e3);
  DataRate start_bitrate = DataRate::BitsPerSecond(1e6);
  DataRate max_bitrate = DataRate::BitsPerSecond(50e6);
  /// The least useful target, between min_bitrate and max_bitrate. The target falls below it only
  /// if the path cannot carry it, and never falls below min_bitrate. 0 means that there is no such
  /// value.
  DataRate needed_bitrate{};
  /// If true, the stream takes precedence over all other streams, and gets its maximum before the
  /// others get more than they need.
  bool strict = false;

  DataRate need() const { return std::max(min_bitrate, needed_bitrate); }
  DataRate most() const { return std::max(min_bitrate, max_bitrate); }
};

/// A packet that enters the sender's queue. `size` is its size on the wire, with RTP, UDP and IP
/// headers.
struct QueuedPacket {
  std::uint32_t ssrc = 0;
  DataSize size;
  bool marker = false;              ///< last packet of an access unit
  std::uint32_t rtp_timestamp = 0;  ///< the same for all packets of an access unit
  /// The number of a group of access units that are useful only together, such as the slices of a
  /// scan.
  std::optional<std::uint32_t> group = std::nullopt;
};

/// A packet that leaves the head of a stream's queue.
struct SentPacket {
  std::uint32_t ssrc = 0;
  std::uint16_t seq = 0;
  DataSize size;
  Ecn ecn = Ecn::kNotEct;  ///< as sent, usually SendDecision::ecn
};

}  // namespace lidar::scream
