// SPDX-License-Identifier: LGPL-2.1-or-later
// Splits slices and stream configs into RTP payloads, or puts several small slices into one
// payload.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/rtp/payload_header.h"

namespace lidar::rtp {

/// An RTP payload. It consists of `header` and of `body_size` bytes of the unit, starting at
/// `body_offset`. So the unit is not copied.
struct Packet {
  std::vector<std::uint8_t> header;
  std::size_t body_offset = 0;
  std::size_t body_size = 0;
  bool marker = false;  // true for the last packet of a slice
};

/// Splits `bytes`, the body of `unit`, into packets of at most `max_payload` bytes. Sets the type,
/// length and CRC of the unit. Returns no packets if `bytes` is empty or longer than kMaxUnitBytes,
/// or if `max_payload` is less than kMinPayload.
std::vector<Packet> Packetize(Unit unit, ByteView bytes, std::size_t max_payload);

/// Collects small slices for an aggregation packet.
class Aggregator {
 public:
  /// Adds a unit. `rtp_ticks` is its running time in units of 1 / 90000 s. Returns false and adds
  /// nothing if the unit does not fit into the packet. Does so also if its `rtp_ticks` exceed the
  /// `rtp_ticks` of the first unit by more than 16 bits can represent.
  bool Add(Unit unit, ByteView bytes, std::size_t max_payload, std::uint64_t rtp_ticks);
  /// Returns the packet. Its RTP timestamp must be the timestamp of the first unit. If there is
  /// only one unit, the result is a single unit packet. If there is no unit, returns nothing.
  std::optional<Packet> Take();
  bool empty() const { return units_ == 0; }

 private:
  std::vector<std::uint8_t> payload_;
  std::size_t units_ = 0;
  std::uint64_t first_ticks_ = 0;
};

/// Numbers the scans that are sent. Also lists slices that were not sent, so that a receiver does
/// not count them as lost.
class ScanCounter {
 public:
  explicit ScanCounter(std::uint32_t first) : number_(first) {}
  /// Sets the unit type, the scan number and the skipped slices of `unit`. Must be called for each
  /// slice in the order of sending. The index, count and scan id of the unit must be set.
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
  std::uint64_t skipped_ = 0;  // bits as in SliceInfo
};

}  // namespace lidar::rtp
