// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/ouster/lidar_packet.h"

#include "src/base/crc.h"

namespace lidar::ouster {
namespace {

constexpr std::size_t kLegacyFrameIdOffset = 10;  // offset in every column header

std::uint64_t LittleAt(ByteView bytes, std::size_t offset, std::size_t n) {
  ByteReader r(bytes.Sub(offset, n));
  switch (n) {
    case 1:
      return r.U8();
    case 2:
      return r.Le16();
    case 3:
      return r.Le24();
    case 4:
      return r.Le32();
    case 5:
      return r.Le40();
    default:
      return r.Le64();
  }
}

PacketHeader ReadHeader(ByteView bytes, const PacketFormat& format) {
  PacketHeader header;
  if (format.is_legacy()) {
    header.type = kLidarPacketType;
    header.frame_id = static_cast<std::uint32_t>(LittleAt(bytes, kLegacyFrameIdOffset, 2));
    return header;
  }
  const HeaderLayout& at = format.is_fusa() ? kFusaHeader : kStandardHeader;
  header.type = static_cast<std::uint16_t>(LittleAt(bytes, 0, at.type_bytes));
  header.frame_id = static_cast<std::uint32_t>(LittleAt(bytes, at.frame_id, at.frame_id_bytes));
  header.init_id = static_cast<std::uint32_t>(LittleAt(bytes, at.init_id, 3));
  header.serial = LittleAt(bytes, at.serial, 5);
  return header;
}

}  // namespace

std::optional<LidarPacket> LidarPacket::Parse(ByteView bytes, const PacketFormat& format) {
  if (bytes.empty() || bytes.size != format.packet_size()) return std::nullopt;
  LidarPacket packet(bytes, format);
  packet.header_ = ReadHeader(bytes, format);
  return packet;
}

std::optional<PacketHeader> PeekHeader(ByteView bytes, const PacketFormat& format) {
  if (format.is_legacy() || bytes.size < format.packet_header_size()) return std::nullopt;
  return ReadHeader(bytes, format);
}

PacketColumn LidarPacket::Column(std::uint32_t i) const {
  const ByteView block =
      bytes_.Sub(format_.packet_header_size() + i * format_.column_size(), format_.column_size());
  ByteReader r(block);
  PacketColumn column;
  column.timestamp = r.Le64();
  column.measurement_id = r.Le16();
  column.status = format_.is_legacy()
                      ? static_cast<std::uint32_t>(LittleAt(block, block.size - 4, 4))
                      : r.Le16();
  column.pixels = block.data + format_.column_header_size();
  return column;
}

bool PacketCrcCheck::Accept(ByteView packet) {
  constexpr std::uint32_t kGiveUpAfter = 64;  // packets without a valid CRC
  constexpr std::size_t kCrcSize = 8;
  if (!carried_ || packet.size <= kCrcSize) return true;
  if (!seen_valid_ && unseen_ >= kGiveUpAfter) return true;
  const std::size_t body = packet.size - kCrcSize;
  const bool matches = Crc64(packet.Sub(0, body)) == LittleAt(packet, body, kCrcSize);
  seen_valid_ = seen_valid_ || matches;
  if (!seen_valid_) ++unseen_;
  return matches || !seen_valid_;
}

}  // namespace lidar::ouster
