// SPDX-License-Identifier: LGPL-2.1-or-later
// Changes what a recorded lidar packet says about its sensor and its time.
#pragma once
#include <cstdint>
#include <vector>

#include "src/ouster/packet_format.h"

namespace lidar::tools {

struct PacketPatch {
  std::uint32_t init_id = 0;  // 0: as it is
  std::uint64_t serial = 0;   // 0: as it is
  std::uint32_t add_frames = 0;
  std::uint64_t first_time_ns = 0;  // the recording's first column ...
  std::uint64_t new_time_ns = 0;    // ... becomes this, and the others keep their distance
  double speed = 1;                 // divided by this
};

/// `packet` is one packet of `format`. A CRC that was right is right again.
void ApplyPatch(const PacketPatch& patch, const ouster::PacketFormat& format,
                std::vector<std::uint8_t>* packet);

}  // namespace lidar::tools
