// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/tools/ouster_replay/pcap_stream.h"

#include <stdexcept>

#include "src/ouster/lidar_packet.h"
#include "src/ouster/pcap_reader.h"
#include "src/tools/ouster_replay/packet_patch.h"

namespace lidar::tools {

PcapStream::PcapStream(const std::string& path, const ouster::Metadata& metadata,
                       const Options& options)
    : format_(metadata.format), options_(options) {
  std::string error;
  const auto reader = ouster::PcapReader::Open(path, &error);
  if (!reader) throw std::runtime_error("cannot read " + path + ": " + error);
  std::optional<Time> first;
  std::optional<std::uint32_t> first_frame;
  std::uint32_t last_frame = 0;
  while (auto captured = reader->Next()) {
    std::vector<std::uint8_t>& bytes = captured->datagram.payload;
    const auto lidar = ouster::LidarPacket::Parse({bytes.data(), bytes.size()}, format_);
    const bool imu = bytes.size() == metadata.imu_packet_size();
    if (!lidar && !imu) continue;
    if (lidar) {
      if (!first_frame) {
        first_frame = lidar->header().frame_id;
        first_time_ns_ = lidar->Column(0).timestamp;
      }
      last_frame = lidar->header().frame_id;
    }
    if (!first) first = captured->time;
    packets_.push_back({captured->time - *first, imu, std::move(bytes)});
  }
  if (!first_frame)
    throw std::runtime_error(path + " holds no packets of the sensor in the metadata");
  scans_ = static_cast<std::uint32_t>(last_frame - *first_frame) + 1;
  // Whole scans, so that the first of a round follows the last of the round before.
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
  if (packet.imu) return packet;
  PacketPatch patch;
  patch.init_id = start_.init_id;
  patch.serial = options_.serial;
  patch.add_frames = scans_ * rounds_;
  patch.first_time_ns = first_time_ns_;
  patch.new_time_ns = start_.sensor_time_ns + static_cast<std::uint64_t>(at_speed(offset).count());
  patch.speed = options_.speed;
  ApplyPatch(patch, format_, &packet.bytes);
  return packet;
}

}  // namespace lidar::tools
