// SPDX-License-Identifier: LGPL-2.1-or-later
// Cuts slices and stream configs into RTP payloads, or joins small slices into one payload.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/rtp/payload_header.h"

namespace lidar::rtp {

/// An RTP payload: `header`, then `body_size` bytes of the unit from `body_offset`, so that the
/// caller need not copy the unit.
struct Packet {
  std::vector<std::uint8_t> header;
  std::size_t body_offset = 0;
  std::size_t body_size = 0;
  bool marker = false;  // the last packet of a slice
};

/// Cuts `bytes`, the body of `unit`, into packets of at most `max_payload` bytes. Computes the
/// unit's type, length and CRC. Returns no packets if there are no bytes or more than
/// kMaxUnitBytes, or if `max_payload` is below kMinPayload.
std::vector<Packet> Packetize(Unit unit, ByteView bytes, std::size_t max_payload);

/// Collects small slices into one aggregation packet.
class Aggregator {
 public:
  /// Returns false and adds nothing if the unit does not fit into the packet, or if its `rtp_ticks`
  /// (running time in 90 kHz) exceed those of the first unit by more than 16 bits can hold.
  bool Add(Unit unit, ByteView bytes, std::size_t max_payload, std::uint64_t rtp_ticks);
  /// Returns the packet, which has the RTP timestamp of its first unit; it is a single unit packet
  /// if there is only one unit. Returns nothing if there is no unit.
  std::optional<Packet> Take();
  bool empty() const { return units_ == 0; }

 private:
  std::vector<std::uint8_t> payload_;
  std::size_t units_ = 0;
  std::uint64_t first_ticks_ = 0;
};

/// Numbers the scans that are sent, and announces unsent slices, so that a receiver does not count
/// them as lost.
class ScanCounter {
 public:
  explicit ScanCounter(std::uint32_t first) : number_(first) {}
  /// Sets unit type, scan number and skipped slices of `unit`, the next slice to send. The unit's
  /// index, count and scan id must be set.
  void Place(Unit* unit);

 private:
  struct Last {
    std::uint32_t scan_id;
    std::uint16_t index;
    std::uint16_t count;
  };
  void Skip(unsigned slices);

  std::optional<Last> last_;
  std::uint32_t number_;
  std::uint64_t skipped_ = 0;  // as in SliceInfo
};

}  // namespace lidar::rtp
