// SPDX-License-Identifier: LGPL-2.1-or-later
// The headers of slices and stream configs in an RTP payload (docs/wire-format.md).
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/byte_reader.h"

namespace lidar::rtp {

/// The kinds of packets, with their numbers in draft-engelbart-avtcore-rtp-gpcc.
enum class PacketType : std::uint8_t {
  kSingle = 0,
  kAggregation = 1,
  kFirstFragment = 2,
  kMiddleFragment = 3,
  kLastFragment = 4,
};
/// The kinds of units. The draft calls the stream config a sequence parameter set, and the slice a
/// geometry data unit.
enum class UnitType : std::uint8_t {
  kStreamConfig = 0,
  kSlice = 2,
  kSliceAfterSkip = 3,  // a slice with a list of skipped slices before it
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

/// The position of a slice in the stream. It is in every packet of the slice.
struct SliceId {
  std::uint32_t scan_number = 0;  // number of the scan, counted without gaps; wraps around
  std::uint16_t index = 0;
  std::uint16_t count = 1;  // number of slices in the scan
};

/// The header fields that are only in the first packet of a slice.
struct SliceInfo {
  std::uint32_t scan_id = 0;  // the source's number of the scan; has gaps for skipped scans
  std::uint16_t first_column = 0;
  std::uint32_t duration_ns = kUnknownDuration;
  std::uint64_t capture_ntp = 0;  // 0 if not known
  // If bit n is set, the sender skipped the slice that is n + 1 slices before this slice. That
  // slice may belong to an earlier scan. Only used for kSliceAfterSkip.
  std::uint64_t skipped = 0;

  static constexpr std::uint32_t kUnknownDuration = 0xFFFF'FFFF;
};

/// A unit or a fragment of a unit, as parsed from a packet.
struct Unit {
  PacketType type = PacketType::kSingle;
  UnitType unit = UnitType::kSlice;
  std::uint8_t config_id = 0;
  SliceId slice;                      // only for slices
  SliceInfo info;                     // only for slices, if StartsUnit(type)
  std::uint32_t length = 0;           // size of the whole unit [bytes], if StartsUnit(type)
  std::uint32_t crc = 0;              // UnitCrc() of the whole unit, if StartsUnit(type)
  std::uint16_t timestamp_ticks = 0;  // since the RTP timestamp; always 0 outside of aggregates
  ByteView body;
};

constexpr std::size_t kCommonHeaderSize = 2;
constexpr std::size_t kStartHeaderSize = 8;  // the length and the CRC
constexpr std::size_t kSliceIdSize = 8;
constexpr std::size_t kSliceInfoSize = 18;
constexpr std::size_t kSkippedSize = 8;
constexpr std::size_t kAggregateUnitSize = 4;  // the ticks and the size before each unit
constexpr std::size_t kMaxUnitBytes = std::size_t{4} << 20;
constexpr std::uint16_t kMaxSlicesPerScan = 4096;
/// The least payload size. A smaller payload could have only headers.
constexpr std::size_t kMinPayload = 64;

std::size_t HeaderSize(PacketType type, UnitType unit);
/// Appends the header of `unit`, which is everything but its body.
void WriteHeader(const Unit& unit, std::vector<std::uint8_t>* out);
/// Returns the CRC-32 of the unit's header fields and its bytes. The header fields are included,
/// because a damaged time or index is as wrong as a damaged point.
std::uint32_t UnitCrc(const Unit& unit, ByteView bytes);

/// Returns the units of a packet. If any part of the packet is malformed, returns no units.
std::vector<Unit> ParsePayload(ByteView payload);

}  // namespace lidar::rtp
