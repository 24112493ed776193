// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads a capture as a stream of packets, once or in an endless loop.
#pragma once
#include <string>
#include <vector>

#include "src/tools/bench/ouster_replay/packet_stream.h"

namespace lidar::tools {

class PcapStream : public PacketStream {
 public:
  struct Options {
    bool loop = true;
    double speed = 1;
    std::uint64_t serial = 0;  // 0: as in the capture
  };
  /// Reads the whole capture into memory, so that no disk delays a packet. Throws
  /// std::runtime_error if the capture cannot be read or has no packets of the sensor.
  PcapStream(const std::string& path, const ouster::Metadata& metadata, const Options& options);

  void Restart(const Start& start) override;
  std::optional<OutPacket> Next() override;

 private:
  std::vector<OutPacket> packets_;
  ouster::PacketFormat format_;
  std::vector<std::size_t> imu_times_;  // offsets of the times in an IMU packet
  bool imu_has_header_;
  Options options_;
  Duration round_{};  // duration of all scans of the capture
  std::uint32_t scans_ = 0;
  std::uint64_t first_time_ns_ = 0;
  Start start_;
  std::size_t next_ = 0;
  std::uint32_t rounds_ = 0;
};

}  // namespace lidar::tools
