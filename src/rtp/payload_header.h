// SPDX-License-Identifier: LGPL-2.1-or-later
// The headers in front of slices and stream configs in an RTP payload (docs/wire-format.md).
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"

namespace lidar::rtp {

/// The content of a packet, with the numbers of draft-engelbart-avtcore-rtp-gpcc.
enum class PacketType : std::uint8_t {
  kSingle = 0,
  kAggregation = 1,
  kFirstFragment = 2,
  kMiddleFragment = 3,
  kLastFragment = 4,
};
/// The draft's sequence parameter set and geometry data unit are our config and our slice.
enum class UnitType : std::uint8_t {
  kStreamConfig = 0,
  kSlice = 2,
  kSliceAfterSkip = 3,  // a slice that lists skipped slices before it
};

constexpr bool IsSlice(UnitType t) {
  return t == UnitType::kSlice || t == UnitType::kSliceAfterSkip;
}

constexpr bool StartsUnit(PacketType t) {
  return t == PacketType::kSingle || t == PacketType::kFirstFragment;
}
constexpr bool EndsUnit(PacketType t) {
  return t == PacketType::kSingle || t == PacketType::kLastFragment;
}

/// Identifies the slice of a packet. Each packet of a slice has it.
struct SliceId {
  std::uint32_t scan_number = 0;  // counts the scans sent, without gaps; wraps
  std::uint16_t index = 0;
  std::uint16_t count = 1;  // slices of the scan
};

/// Fields of the first packet of a slice.
struct SliceInfo {
  std::uint32_t scan_id = 0;  // the source's number, with gaps for skipped scans
  std::uint16_t first_column = 0;
  std::uint32_t duration_ns = kUnknownDuration;
  std::uint64_t capture_ntp = 0;  // 0: not known
  // Bit n: the sender skipped the slice that is n + 1 slices earlier, which may be of an earlier
  // scan. For kSliceAfterSkip only.
  std::uint64_t skipped = 0;

  static constexpr std::uint32_t kUnknownDuration = 0xFFFF'FFFF;
};

/// A unit, or a fragment of one, as found in a packet.
struct Unit {
  PacketType type = PacketType::kSingle;
  UnitType unit = UnitType::kSlice;
  std::uint8_t config_id = 0;
  SliceId slice;                      // of slices
  SliceInfo info;                     // of slices, if StartsUnit(type)
  std::uint32_t length = 0;           // bytes of the whole unit, if StartsUnit(type)
  std::uint32_t crc = 0;              // UnitCrc of the whole unit, if StartsUnit(type)
  std::uint16_t timestamp_ticks = 0;  // relative to the RTP timestamp; not 0 only in aggregates
  ByteView body;
};

constexpr std::size_t kCommonHeaderSize = 2;
constexpr std::size_t kStartHeaderSize = 8;  // length and CRC
constexpr std::size_t kSliceIdSize = 8;
constexpr std::size_t kSliceInfoSize = 18;
constexpr std::size_t kSkippedSize = 8;
constexpr std::size_t kAggregateUnitSize = 4;  // ticks and size in front of each unit
constexpr std::size_t kMaxUnitBytes = std::size_t{4} << 20;
constexpr std::uint16_t kMaxSlicesPerScan = 4096;
/// Smaller payloads would be headers only.
constexpr std::size_t kMinPayload = 64;

std::size_t HeaderSize(PacketType type, UnitType unit);
/// Appends the header of `unit` (all but its body).
void WriteHeader(const Unit& unit, std::vector<std::uint8_t>* out);
/// CRC-32 of the unit's description and its bytes, because a damaged time or index is as wrong as a
/// damaged point.
std::uint32_t UnitCrc(const Unit& unit, ByteView bytes);

/// Returns the units of a packet, or no units if any part is malformed.
std::vector<Unit> ParsePayload(ByteView payload);

}  // namespace lidar::rtp
