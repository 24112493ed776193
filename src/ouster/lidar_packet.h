// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the fields of a lidar packet. Only the size of the packet is checked.
#pragma once
#include <cstdint>
#include <optional>

#include "src/base/byte_reader.h"
#include "src/ouster/packet_format.h"

namespace lidar::ouster {

struct PacketHeader {
  std::uint16_t type = 0;
  std::uint32_t frame_id = 0;
  std::uint32_t init_id = 0;  // 0: unknown
  std::uint64_t serial = 0;   // 0: unknown
};

/// A measurement block of a packet: the pixels of one column.
struct PacketColumn {
  std::uint64_t timestamp = 0;  // ns of the sensor's clock
  std::uint32_t measurement_id = 0;
  std::uint32_t status = 0;
  const std::uint8_t* pixels = nullptr;

  bool valid() const { return (status & 1U) != 0; }
};

/// Reads one channel of a pixel.
class ChannelReader {
 public:
  explicit ChannelReader(const ChannelBits& bits)
      : word_(bits.first_bit / 32 * 4),
        shift_(bits.first_bit % 32U),
        scale_shift_(bits.scale_shift),
        mask_(bits.bits >= 32 ? ~0U : (1U << bits.bits) - 1) {}

  std::uint32_t Read(const std::uint8_t* pixel) const {
    const std::uint8_t* w = pixel + word_;
    const std::uint32_t word =
        w[0] | std::uint32_t{w[1]} << 8 | std::uint32_t{w[2]} << 16 | std::uint32_t{w[3]} << 24;
    return (word >> shift_ & mask_) << scale_shift_;
  }

 private:
  std::uint32_t word_;  // offset in the pixel [bytes]
  std::uint32_t shift_;
  std::uint32_t scale_shift_;
  std::uint32_t mask_;
};

/// A view of a lidar packet. The packet's bytes must outlive it.
class LidarPacket {
 public:
  /// Returns nothing unless `bytes` are exactly one packet of `format`.
  static std::optional<LidarPacket> Parse(ByteView bytes, const PacketFormat& format);

  const PacketHeader& header() const { return header_; }
  std::uint32_t columns() const { return format_.columns_per_packet; }
  /// Requires `i` < columns().
  PacketColumn Column(std::uint32_t i) const;

 private:
  LidarPacket(ByteView bytes, const PacketFormat& format) : bytes_(bytes), format_(format) {}

  ByteView bytes_;
  PacketFormat format_;
  PacketHeader header_;
};

/// Returns the header of a packet of any size, for example of a packet from a sensor in another
/// mode. Returns nothing for LEGACY packets, which have no header, and for bytes that are too
/// short.
std::optional<PacketHeader> PeekHeader(ByteView bytes, const PacketFormat& format);

/// Checks the CRC-64 of packets. Firmware before 2.4 and FUSA packets have a constant in place of
/// the CRC. So a wrong CRC means damage only if an earlier packet of the sensor had a correct CRC.
class PacketCrcCheck {
 public:
  explicit PacketCrcCheck(const PacketFormat& format) : carried_(!format.is_legacy()) {}
  /// Returns false if the packet is damaged.
  bool Accept(ByteView packet);

 private:
  bool carried_;
  bool seen_valid_ = false;
  std::uint32_t unseen_ = 0;
};

}  // namespace lidar::ouster
