// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/ouster_replay/packet_patch.h"

#include "src/base/crc.h"

namespace lidar::tools {
namespace {

constexpr std::size_t kCrcSize = 8;
constexpr std::size_t kLegacyFrameId = 10;  // in each column header

std::uint64_t Get(const std::uint8_t* at, std::size_t n) {
  std::uint64_t v = 0;
  for (std::size_t i = 0; i < n; ++i) v |= std::uint64_t{at[i]} << (8 * i);
  return v;
}

void Put(std::uint8_t* at, std::uint64_t v, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) at[i] = static_cast<std::uint8_t>(v >> (8 * i));
}

}  // namespace

void ApplyPatch(const PacketPatch& patch, const ouster::PacketFormat& format,
                std::vector<std::uint8_t>* packet) {
  std::uint8_t* bytes = packet->data();
  const std::size_t body = packet->size() - kCrcSize;
  const bool had_crc = !format.is_legacy() && Crc64({bytes, body}) == Get(bytes + body, kCrcSize);
  if (!format.is_legacy()) {
    const auto& at = format.is_fusa() ? ouster::kFusaHeader : ouster::kStandardHeader;
    if (patch.init_id != 0) Put(bytes + at.init_id, patch.init_id, 3);
    if (patch.serial != 0) Put(bytes + at.serial, patch.serial, 5);
    const std::uint64_t frame = Get(bytes + at.frame_id, at.frame_id_bytes) + patch.add_frames;
    Put(bytes + at.frame_id, frame, at.frame_id_bytes);
  }
  for (std::uint32_t i = 0; i < format.columns_per_packet; ++i) {
    std::uint8_t* column = bytes + format.packet_header_size() + i * format.column_size();
    const double since_first =
        static_cast<double>(static_cast<std::int64_t>(Get(column, 8) - patch.first_time_ns));
    Put(column,
        patch.new_time_ns +
            static_cast<std::uint64_t>(static_cast<std::int64_t>(since_first / patch.speed)),
        8);
    if (format.is_legacy())
      Put(column + kLegacyFrameId, Get(column + kLegacyFrameId, 2) + patch.add_frames, 2);
  }
  if (had_crc) Put(bytes + body, Crc64({bytes, body}), kCrcSize);
}

}  // namespace lidar::tools
