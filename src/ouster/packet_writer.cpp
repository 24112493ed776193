// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/ouster/packet_writer.h"

#include <algorithm>

#include "src/base/crc.h"

namespace lidar::ouster {
namespace {

constexpr std::size_t kCrcSize = 8;
constexpr std::size_t kMeasurementIdOffset = 8;
constexpr std::size_t kStatusOffset = 10;  // LEGACY has the frame id here, the status at the end
constexpr std::size_t kEncoderOffset = 12;
constexpr std::uint32_t kEncoderTicks = 90112;  // one revolution of the encoder, in LEGACY packets

void PutLittle(std::uint8_t* at, std::uint64_t value, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) at[i] = static_cast<std::uint8_t>(value >> (8 * i));
}

/// Writes the low `bits` bits of `value` into the pixel, starting at its bit `first`.
void PutBits(std::uint8_t* pixel, unsigned first, unsigned bits, std::uint32_t value) {
  while (bits > 0) {
    const unsigned shift = first % 8;
    const unsigned n = std::min(8 - shift, bits);
    const unsigned mask = ((1U << n) - 1) << shift;
    std::uint8_t& byte = pixel[first / 8];
    byte = static_cast<std::uint8_t>((byte & ~mask) | (value << shift & mask));
    value >>= n;
    first += n;
    bits -= n;
  }
}

}  // namespace

PacketWriter::PacketWriter(const PacketFormat& format, const PacketIdentity& identity)
    : format_(format),
      identity_(identity),
      layout_(LayoutOf(format.profile)),
      column_size_(format.column_size()),
      bytes_(format.packet_size()) {}

std::uint8_t* PacketWriter::ColumnAt(std::uint32_t column) {
  return &bytes_[format_.packet_header_size() + column * column_size_];
}

void PacketWriter::Begin(std::uint32_t frame_id) {
  std::fill(bytes_.begin(), bytes_.end(), std::uint8_t{0});
  frame_id_ = frame_id;
  if (format_.is_legacy()) return;
  const HeaderLayout& at = format_.is_fusa() ? kFusaHeader : kStandardHeader;
  PutLittle(bytes_.data(), kLidarPacketType, at.type_bytes);
  PutLittle(&bytes_[at.frame_id], frame_id, at.frame_id_bytes);
  PutLittle(&bytes_[at.init_id], identity_.init_id, 3);
  PutLittle(&bytes_[at.serial], identity_.serial, 5);
}

void PacketWriter::SetColumn(std::uint32_t column, const ColumnHeader& header) {
  std::uint8_t* at = ColumnAt(column);
  PutLittle(at, header.timestamp, 8);
  PutLittle(at + kMeasurementIdOffset, header.measurement_id, 2);
  if (format_.is_legacy()) {
    PutLittle(at + kStatusOffset, frame_id_, 2);
    PutLittle(at + kEncoderOffset, header.measurement_id % kEncoderTicks, 4);
    PutLittle(at + column_size_ - 4, header.valid ? 0xffffffffU : 0, 4);
  } else {
    PutLittle(at + kStatusOffset, header.valid ? 1 : 0, 2);
  }
}

void PacketWriter::SetPixel(Pixel at, Channel channel, std::uint32_t value) {
  const ChannelBits* bits = layout_.Find(channel);
  if (bits == nullptr) return;
  std::uint8_t* pixel =
      ColumnAt(at.column) + format_.column_header_size() + std::size_t{at.beam} * layout_.bytes;
  PutBits(pixel, bits->first_bit, bits->bits, value >> bits->scale_shift);
}

const std::vector<std::uint8_t>& PacketWriter::Finish() {
  // FUSA packets have zeros in place of the CRC.
  if (format_.is_legacy() || format_.is_fusa() || bytes_.size() <= kCrcSize) return bytes_;
  const std::size_t body = bytes_.size() - kCrcSize;
  PutLittle(&bytes_[body], Crc64({bytes_.data(), body}), kCrcSize);
  return bytes_;
}

}  // namespace lidar::ouster
