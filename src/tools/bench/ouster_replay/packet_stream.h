// SPDX-License-Identifier: LGPL-2.1-or-later
// The packets of a simulated sensor.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/time.h"
#include "src/ouster/metadata.h"

namespace lidar::tools {

struct OutPacket {
  Duration due{};  // since the stream started
  bool imu = false;
  std::vector<std::uint8_t> bytes;
};

class PacketStream {
 public:
  virtual ~PacketStream() = default;

  struct Start {
    std::uint32_t init_id = 0;
    std::uint64_t sensor_time_ns = 0;  // of the first column
  };
  /// Starts from the first packet again, as after a boot.
  virtual void Restart(const Start& start) = 0;
  /// Packets in order of `due`; nothing at the end.
  virtual std::optional<OutPacket> Next() = 0;
};

}  // namespace lidar::tools
