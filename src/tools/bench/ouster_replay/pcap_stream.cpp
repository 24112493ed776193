// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/bench/ouster_replay/pcap_stream.h"

#include <cstdint>
#include <stdexcept>
#include <vector>

#include "src/base/crc.h"
#include "src/ouster/imu_packet.h"
#include "src/ouster/lidar_packet.h"
#include "src/ouster/packet_format.h"
#include "src/ouster/pcap_reader.h"

namespace lidar::tools {
namespace {

/// The changes to make to a recorded packet.
struct PacketPatch {
  std::uint32_t init_id = 0;  // 0: unchanged
  std::uint64_t serial = 0;   // 0: unchanged
  std::uint32_t add_frames = 0;
  std::uint64_t first_time_ns = 0;  // recorded time of the first valid column
  std::uint64_t new_time_ns = 0;    // new time of this column
  double speed = 1;                 // divides the time since this column
};

constexpr std::size_t kCrcSize = 8;
constexpr std::size_t kLegacyFrameId = 10;  // offset in each column header

std::uint64_t Get(const std::uint8_t* at, std::size_t n) {
  std::uint64_t v = 0;
  for (std::size_t i = 0; i < n; ++i) v |= std::uint64_t{at[i]} << (8 * i);
  return v;
}

void Put(std::uint8_t* at, std::uint64_t v, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) at[i] = static_cast<std::uint8_t>(v >> (8 * i));
}

/// Returns the time of the first valid column. The time of an invalid column has no meaning.
std::optional<std::uint64_t> TimeOf(const ouster::LidarPacket& packet) {
  for (std::uint32_t i = 0; i < packet.columns(); ++i)
    if (packet.Column(i).valid()) return packet.Column(i).timestamp;
  return std::nullopt;
}

/// Replaces the recorded time at `at` by the new time.
void PutTime(const PacketPatch& patch, std::uint8_t* at) {
  const double since_first =
      static_cast<double>(static_cast<std::int64_t>(Get(at, 8) - patch.first_time_ns));
  Put(at,
      patch.new_time_ns +
          static_cast<std::uint64_t>(static_cast<std::int64_t>(since_first / patch.speed)),
      8);
}

/// Changes the header of a packet. Lidar packets and IMU packets of the profile ACCEL32_GYRO32_NMEA
/// have the same header.
void ApplyToHeader(const PacketPatch& patch, const ouster::PacketFormat& format,
                   std::uint8_t* bytes) {
  const auto& at = format.is_fusa() ? ouster::kFusaHeader : ouster::kStandardHeader;
  if (patch.init_id != 0) Put(bytes + at.init_id, patch.init_id, 3);
  if (patch.serial != 0) Put(bytes + at.serial, patch.serial, 5);
  const std::uint64_t frame = Get(bytes + at.frame_id, at.frame_id_bytes) + patch.add_frames;
  Put(bytes + at.frame_id, frame, at.frame_id_bytes);
}

/// Changes a lidar packet. `bytes` must have the format `format`.
void ApplyToLidar(const PacketPatch& patch, const ouster::PacketFormat& format,
                  std::uint8_t* bytes) {
  if (!format.is_legacy()) ApplyToHeader(patch, format, bytes);
  for (std::uint32_t i = 0; i < format.columns_per_packet; ++i) {
    std::uint8_t* column = bytes + format.packet_header_size() + i * format.column_size();
    PutTime(patch, column);
    if (format.is_legacy())
      Put(column + kLegacyFrameId, Get(column + kLegacyFrameId, 2) + patch.add_frames, 2);
  }
}

/// Calls `change` with the packet's bytes. If the CRC was right before, corrects it afterwards. If
/// `has_crc` is false, the packet has no CRC.
template <class Change>
void KeepCrc(bool has_crc, std::vector<std::uint8_t>* packet, const Change& change) {
  std::uint8_t* bytes = packet->data();
  if (!has_crc) return change(bytes);
  const std::size_t body = packet->size() - kCrcSize;
  const bool had_crc = Crc64({bytes, body}) == Get(bytes + body, kCrcSize);
  change(bytes);
  if (had_crc) Put(bytes + body, Crc64({bytes, body}), kCrcSize);
}

}  // namespace

PcapStream::PcapStream(const std::string& path, const ouster::Metadata& metadata,
                       const Options& options)
    : format_(metadata.format),
      imu_times_(ouster::ImuTimestamps(metadata)),
      imu_has_header_(metadata.imu_profile == ouster::ImuProfile::kAccel32Gyro32Nmea),
      options_(options) {
  std::string error;
  const auto reader = ouster::PcapReader::Open(path, &error);
  if (!reader) throw std::runtime_error("cannot read " + path + ": " + error);
  std::optional<Time> first;
  std::optional<std::uint32_t> first_frame;
  std::optional<std::uint64_t> first_time;
  std::uint32_t last_frame = 0;
  while (auto captured = reader->Next()) {
    std::vector<std::uint8_t>& bytes = captured->datagram.payload;
    const ByteView payload{bytes.data(), bytes.size()};
    const auto lidar = ouster::LidarPacket::Parse(payload, format_);
    const bool imu = ouster::IsImuPacket(payload, metadata);
    if (!lidar && !imu) continue;
    if (lidar) {
      if (!first_frame) first_frame = lidar->header().frame_id;
      if (!first_time) first_time = TimeOf(*lidar);
      last_frame = lidar->header().frame_id;
    }
    if (!first) first = captured->time;
    packets_.push_back({captured->time - *first, imu, std::move(bytes)});
  }
  if (!first_frame)
    throw std::runtime_error(path + " holds no packets of the sensor in the metadata");
  first_time_ns_ = first_time.value_or(0);
  const std::uint64_t ids = format_.frame_id_modulus();
  scans_ = static_cast<std::uint32_t>((ids + last_frame - *first_frame) % ids) + 1;
  // A round is one pass through the capture. It lasts a whole number of scans, so that its first
  // scan follows the last scan of the round before.
  round_ = metadata.scan_period() * scans_;
}

void PcapStream::Restart(const Start& start) {
  start_ = start;
  next_ = 0;
  rounds_ = 0;
}

std::optional<OutPacket> PcapStream::Next() {
  if (next_ == packets_.size()) {
    if (!options_.loop) return std::nullopt;
    next_ = 0;
    ++rounds_;
  }
  OutPacket packet = packets_[next_++];
  const Duration offset = round_ * rounds_;
  const auto at_speed = [&](Duration d) {
    return Duration(static_cast<std::int64_t>(static_cast<double>(d.count()) / options_.speed));
  };
  packet.due = at_speed(packet.due + offset);
  PacketPatch patch;
  patch.init_id = start_.init_id;
  patch.serial = options_.serial;
  patch.add_frames = scans_ * rounds_;
  patch.first_time_ns = first_time_ns_;
  patch.new_time_ns = start_.sensor_time_ns + static_cast<std::uint64_t>(at_speed(offset).count());
  patch.speed = options_.speed;
  KeepCrc(packet.imu || !format_.is_legacy(), &packet.bytes, [&](std::uint8_t* bytes) {
    if (!packet.imu) return ApplyToLidar(patch, format_, bytes);
    if (imu_has_header_) ApplyToHeader(patch, format_, bytes);
    for (const std::size_t at : imu_times_) PutTime(patch, bytes + at);
  });
  return packet;
}

}  // namespace lidar::tools
