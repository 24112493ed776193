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
  Duration due{};  // time to send the packet, since the stream started
  bool imu = false;
  std::vector<std::uint8_t> bytes;
};

class PacketStream {
 public:
  virtual ~PacketStream() = default;

  struct Start {
    std::uint32_t init_id = 0;
    std::uint64_t sensor_time_ns = 0;  // sensor time of the first column
  };
  /// Starts with the first packet again, as a sensor does after a boot.
  virtual void Restart(const Start& start) = 0;
  /// Returns the next packet in the order of `due`, or nothing at the end of the stream.
  virtual std::optional<OutPacket> Next() = 0;
};

}  // namespace lidar::tools
