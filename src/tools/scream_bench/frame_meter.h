// SPDX-License-Identifier: LGPL-2.1-or-later
// What the receiver of scream-bench learns from the packets of one stream.
#pragma once
#include <cstdint>
#include <optional>

#include "src/base/sequence.h"
#include "src/base/time.h"
#include "src/base/units.h"
#include "src/tools/common/distribution.h"

namespace lidar::tools {

struct ReceivedPacket {
  std::uint16_t sequence = 0;
  std::uint32_t timestamp = 0;  // 90 kHz
  bool marker = false;
  bool is_ce = false;
  DataSize size;          // on the wire
  Duration unix_time{0};  // of its arrival
};

/// Age of frames: from their creation to the arrival of their last packet.
class FrameMeter {
 public:
  /// The age of the frame that this packet ends, if it does.
  std::optional<Duration> OnPacket(const ReceivedPacket& packet);

  std::uint64_t packets() const { return packets_; }
  std::uint64_t ce_packets() const { return ce_packets_; }
  DataSize received() const { return received_; }
  /// Packets between the oldest and the newest that never came.
  std::uint64_t lost() const;
  std::uint64_t frames() const { return ages_ms_.count(); }
  /// True where the sender's clock is another, so that ages count from the youngest frame's.
  bool is_relative() const { return offset_ != Duration{0}; }
  const Distribution& ages_ms() const { return ages_ms_; }

 private:
  SequenceUnwrapper<std::uint16_t> sequence_;
  std::optional<std::int64_t> first_sequence_;
  std::uint64_t packets_ = 0;
  std::uint64_t ce_packets_ = 0;
  DataSize received_;
  Duration offset_{0};
  Distribution ages_ms_;
};

}  // namespace lidar::tools
