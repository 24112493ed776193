// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rtp/payload_header.h"

#include "src/base/byte_writer.h"
#include "src/base/crc.h"

namespace lidar::rtp {
namespace {

std::uint8_t FirstByte(PacketType type, UnitType unit) {
  return static_cast<std::uint8_t>(static_cast<unsigned>(type) << 5 | static_cast<unsigned>(unit));
}

void WriteSliceId(const SliceId& id, ByteWriter* w) {
  w->Be32(id.scan_number);
  w->Be16(id.index);
  w->Be16(id.count);
}

void WriteSliceInfo(const SliceInfo& info, ByteWriter* w) {
  w->Be32(info.scan_id);
  w->Be16(info.first_column);
  w->Be32(info.duration_ns);
  w->Be64(info.capture_ntp);
}

void WriteInfo(const Unit& unit, ByteWriter* w) {
  WriteSliceInfo(unit.info, w);
  if (unit.unit == UnitType::kSliceAfterSkip) w->Be64(unit.info.skipped);
}

bool ReadSlice(bool starts, ByteReader* r, Unit* unit) {
  unit->slice.scan_number = r->Be32();
  unit->slice.index = r->Be16();
  unit->slice.count = r->Be16();
  if (starts) {
    unit->info.scan_id = r->Be32();
    unit->info.first_column = r->Be16();
    unit->info.duration_ns = r->Be32();
    unit->info.capture_ntp = r->Be64();
    if (unit->unit == UnitType::kSliceAfterSkip) unit->info.skipped = r->Be64();
  }
  return unit->slice.index < unit->slice.count && unit->slice.count <= kMaxSlicesPerScan;
}

/// Parses a single unit or a fragment, which must fill `bytes`.
std::optional<Unit> ParseUnit(ByteView bytes) {
  ByteReader r(bytes);
  const std::uint8_t first = r.U8();
  Unit unit;
  unit.type = static_cast<PacketType>(first >> 5);
  unit.unit = static_cast<UnitType>(first & 31);
  unit.config_id = r.U8();
  if (unit.type == PacketType::kAggregation || unit.type > PacketType::kLastFragment ||
      (unit.unit != UnitType::kStreamConfig && !IsSlice(unit.unit))) {
    return std::nullopt;
  }
  const bool starts = StartsUnit(unit.type);
  if (starts) {
    unit.length = r.Be32();
    unit.crc = r.Be32();
  }
  if (IsSlice(unit.unit) && !ReadSlice(starts, &r, &unit)) return std::nullopt;
  unit.body = r.Rest();
  if (!r.ok() || unit.body.empty() || unit.length > kMaxUnitBytes) return std::nullopt;
  if (unit.type == PacketType::kSingle && unit.length != unit.body.size) return std::nullopt;
  if (unit.type == PacketType::kFirstFragment && unit.length <= unit.body.size) return std::nullopt;
  return unit;
}

bool OfOneScan(const Unit& a, const Unit& b) {
  return IsSlice(a.unit) && IsSlice(b.unit) && a.slice.scan_number == b.slice.scan_number &&
         a.slice.count == b.slice.count;
}

std::vector<Unit> ParseAggregate(ByteView bytes) {
  ByteReader r(bytes);
  r.Skip(1);
  std::vector<Unit> units;
  while (r.remaining() > 0) {
    const std::uint16_t ticks = r.Be16();
    const std::uint16_t size = r.Be16();
    auto unit = ParseUnit(r.Bytes(size));
    if (!r.ok() || !unit || unit->type != PacketType::kSingle) return {};
    unit->timestamp_ticks = ticks;
    if (!units.empty() && !OfOneScan(units.front(), *unit)) return {};
    units.push_back(*unit);
  }
  return units;
}

}  // namespace

std::size_t HeaderSize(PacketType type, UnitType unit) {
  const bool slice = IsSlice(unit);
  std::size_t size = kCommonHeaderSize + (slice ? kSliceIdSize : 0);
  if (StartsUnit(type)) size += kStartHeaderSize + (slice ? kSliceInfoSize : 0);
  if (StartsUnit(type) && unit == UnitType::kSliceAfterSkip) size += kSkippedSize;
  return size;
}

void WriteHeader(const Unit& unit, std::vector<std::uint8_t>* out) {
  ByteWriter w(out);
  w.U8(FirstByte(unit.type, unit.unit));
  w.U8(unit.config_id);
  if (StartsUnit(unit.type)) {
    w.Be32(unit.length);
    w.Be32(unit.crc);
  }
  if (!IsSlice(unit.unit)) return;
  WriteSliceId(unit.slice, &w);
  if (StartsUnit(unit.type)) WriteInfo(unit, &w);
}

std::uint32_t UnitCrc(const Unit& unit, ByteView bytes) {
  std::vector<std::uint8_t> said;
  ByteWriter w(&said);
  w.U8(static_cast<std::uint8_t>(unit.unit));
  w.U8(unit.config_id);
  if (IsSlice(unit.unit)) {
    WriteSliceId(unit.slice, &w);
    WriteInfo(unit, &w);
  }
  return Crc32(bytes, Crc32({said.data(), said.size()}));
}

std::vector<Unit> ParsePayload(ByteView payload) {
  if (payload.empty()) return {};
  if (payload.data[0] >> 5 == static_cast<unsigned>(PacketType::kAggregation)) {
    // An aggregation packet has no unit type. Each of its units has its own type.
    return (payload.data[0] & 31) == 0 ? ParseAggregate(payload) : std::vector<Unit>{};
  }
  const auto unit = ParseUnit(payload);
  return unit ? std::vector<Unit>{*unit} : std::vector<Unit>{};
}

}  // namespace lidar::rtp
