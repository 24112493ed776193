// SPDX-License-Identifier: LGPL-2.1-or-later
// What a caller tells about a stream and its packets.
#pragma once
#include <cstdint>
#include <optional>

#include "src/base/time.h"
#include "src/base/units.h"
#include "src/scream/ecn.h"

namespace lidar::scream {

/// Names a stream of one controller; never used again after RemoveStream().
using StreamId = int;

struct StreamConfig {
  double priority = 1;  ///< weight of this stream's share, > 0
  DataRate min_bitrate = DataRate::BitsPerSecond(100e3);
  DataRate start_bitrate = DataRate::BitsPerSecond(1e6);
  DataRate max_bitrate = DataRate::BitsPerSecond(50e6);
  /// What the stream should not be asked to go below while the path can carry it; between
  /// min_bitrate, which holds always, and max_bitrate. 0: none.
  DataRate needed_bitrate{};
  /// Goes before all streams without, and gets its maximum before they get more than they need.
  bool strict = false;
};

/// A packet as it enters the sender's queue. `size` as on the wire: RTP, UDP and IP included.
struct QueuedPacket {
  std::uint32_t ssrc = 0;
  DataSize size;
  bool marker = false;              ///< last packet of an access unit
  std::uint32_t rtp_timestamp = 0;  ///< packets of one access unit share it
  /// Access units that are of use together, as the slices of a scan, share it.
  std::optional<std::uint32_t> group = std::nullopt;
};

/// The packet at the head of a stream's queue, as it leaves.
struct SentPacket {
  std::uint32_t ssrc = 0;
  std::uint16_t seq = 0;
  DataSize size;
  Ecn ecn = Ecn::kNotEct;  ///< as it was really sent (SendDecision::ecn, unless the caller differs)
};

}  // namespace lidar::scream
