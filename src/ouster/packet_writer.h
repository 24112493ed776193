// SPDX-License-Identifier: LGPL-2.1-or-later
// Writes lidar packets for software sensors, converted recordings and tests. The writer shares only
// the description of the format with the parser.
#pragma once
#include <cstdint>
#include <vector>

#include "src/ouster/packet_format.h"

namespace lidar::ouster {

struct PacketIdentity {
  std::uint32_t init_id = 0;
  std::uint64_t serial = 0;
};

class PacketWriter {
 public:
  PacketWriter(const PacketFormat& format, const PacketIdentity& identity);

  /// Starts a packet in which every pixel is zero and every column is invalid.
  void Begin(std::uint32_t frame_id);
  struct ColumnHeader {
    std::uint64_t timestamp = 0;  // ns
    std::uint16_t measurement_id = 0;
    bool valid = true;
  };
  /// `column` is counted from the first column of the packet.
  void SetColumn(std::uint32_t column, const ColumnHeader& header);
  struct Pixel {
    std::uint32_t column = 0;
    std::uint32_t beam = 0;
  };
  /// Writes as many low bits of `value` as the channel has. Does nothing if the profile does not
  /// have the channel.
  void SetPixel(Pixel at, Channel channel, std::uint32_t value);
  /// Returns the packet, with a CRC if the format has one. The result is valid until the next
  /// Begin().
  const std::vector<std::uint8_t>& Finish();

 private:
  std::uint8_t* ColumnAt(std::uint32_t column);

  PacketFormat format_;
  PacketIdentity identity_;
  PixelLayout layout_;
  std::size_t column_size_;
  std::uint32_t frame_id_ = 0;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace lidar::ouster
