// SPDX-License-Identifier: LGPL-2.1-or-later
// A capture as a stream of packets, endless or not.
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
    std::uint64_t serial = 0;  // 0: as it is in the packets
  };
  /// Holds the whole capture in memory, so that no disk delays it. Throws std::runtime_error.
  PcapStream(const std::string& path, const ouster::Metadata& metadata, const Options& options);

  void Restart(const Start& start) override;
  std::optional<OutPacket> Next() override;

 private:
  std::vector<OutPacket> packets_;
  ouster::PacketFormat format_;
  std::vector<std::size_t> imu_times_;  // offsets in an IMU packet
  bool imu_has_header_;
  Options options_;
  Duration round_{};  // duration of the capture's scans
  std::uint32_t scans_ = 0;
  std::uint64_t first_time_ns_ = 0;
  Start start_;
  std::size_t next_ = 0;
  std::uint32_t rounds_ = 0;
};

}  // namespace lidar::tools
