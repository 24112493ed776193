// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/rtp/packetizer.h"

#include <algorithm>

#include "src/base/byte_writer.h"

namespace lidar::rtp {
namespace {

constexpr std::uint8_t kAggregationByte = static_cast<std::uint8_t>(PacketType::kAggregation) << 5;

Packet MakePacket(Unit* unit, PacketType type, std::size_t offset, std::size_t size) {
  unit->type = type;
  Packet p;
  WriteHeader(*unit, &p.header);
  p.body_offset = offset;
  p.body_size = size;
  p.marker = IsSlice(unit->unit) && EndsUnit(type);
  return p;
}

}  // namespace

std::vector<Packet> Packetize(Unit unit, ByteView bytes, std::size_t max_payload) {
  std::vector<Packet> packets;
  if (bytes.empty() || bytes.size > kMaxUnitBytes || max_payload < kMinPayload) return packets;
  unit.length = static_cast<std::uint32_t>(bytes.size);
  unit.crc = UnitCrc(unit, bytes);
  const std::size_t first = max_payload - HeaderSize(PacketType::kSingle, unit.unit);
  const std::size_t next = max_payload - HeaderSize(PacketType::kMiddleFragment, unit.unit);
  if (bytes.size <= first) {
    packets.push_back(MakePacket(&unit, PacketType::kSingle, 0, bytes.size));
    return packets;
  }
  packets.reserve(2 + (bytes.size - first) / next);
  packets.push_back(MakePacket(&unit, PacketType::kFirstFragment, 0, first));
  for (std::size_t offset = first; offset < bytes.size;) {
    const std::size_t size = std::min(next, bytes.size - offset);
    const bool last = offset + size == bytes.size;
    packets.push_back(MakePacket(
        &unit, last ? PacketType::kLastFragment : PacketType::kMiddleFragment, offset, size));
    offset += size;
  }
  return packets;
}

bool Aggregator::Add(Unit unit, ByteView bytes, std::size_t max_payload, std::uint64_t rtp_ticks) {
  const std::size_t size = HeaderSize(PacketType::kSingle, unit.unit) + bytes.size;
  const std::size_t before = empty() ? 1 : payload_.size();
  const std::uint64_t ticks = empty() ? 0 : rtp_ticks - first_ticks_;
  if (bytes.empty() || size > 0xFFFF || before + kAggregateUnitSize + size > max_payload ||
      ticks > 0xFFFF) {
    return false;
  }
  if (empty()) {
    payload_.assign(1, kAggregationByte);
    first_ticks_ = rtp_ticks;
  }
  ByteWriter w(&payload_);
  w.Be16(static_cast<std::uint16_t>(ticks));
  w.Be16(static_cast<std::uint16_t>(size));
  unit.type = PacketType::kSingle;
  unit.length = static_cast<std::uint32_t>(bytes.size);
  unit.crc = UnitCrc(unit, bytes);
  WriteHeader(unit, &payload_);
  w.Bytes(bytes);
  ++units_;
  return true;
}

std::optional<Packet> Aggregator::Take() {
  if (empty()) return std::nullopt;
  Packet p;
  p.marker = true;
  p.header.swap(payload_);
  if (units_ == 1) p.header.erase(p.header.begin(), p.header.begin() + 1 + kAggregateUnitSize);
  units_ = 0;
  return p;
}

void ScanCounter::Place(Unit* unit) {
  const SliceId& id = unit->slice;
  const bool same_scan = last_ && last_->scan_id == unit->info.scan_id && last_->index < id.index;
  if (same_scan) {
    Skip(id.index - last_->index - 1U);
  } else if (last_) {
    ++number_;
    Skip(last_->count - last_->index - 1U);
    Skip(id.index);
  }
  last_ = Last{unit->info.scan_id, id.index, id.count};
  unit->unit = skipped_ == 0 ? UnitType::kSlice : UnitType::kSliceAfterSkip;
  unit->slice.scan_number = number_;
  unit->info.skipped = skipped_;
  skipped_ <<= 1;
}

void ScanCounter::Skip(unsigned slices) {
  constexpr unsigned kBits = 64;
  skipped_ = slices < kBits ? skipped_ << slices : 0;
  const unsigned set = std::min(slices, kBits);
  if (set > 0) skipped_ |= ~std::uint64_t{0} >> (kBits - set);
}

}  // namespace lidar::rtp
