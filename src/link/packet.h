// SPDX-License-Identifier: LGPL-2.1-or-later
// Packets in the link model, and their fates.
#pragma once
#include <cstdint>

#include "src/base/ecn.h"
#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::link {

struct Packet {
  DataSize size;  // including the IP header
  Ecn ecn = Ecn::kNotEct;
  std::uint64_t id = 0;  // set by the caller; the model does not use it
};

enum class Fate : std::uint8_t {
  kDelivered,
  kLost,       // random loss
  kQueueFull,  // tail drop
  kAqmDropped  // an AQM dropped it, because it could not mark it
};

/// A packet that arrived or was dropped. `sojourn` is the time from the packet's arrival in the
/// queue to its transmission or drop.
struct Outcome {
  Packet packet;  // with its final ECN bits
  Fate fate = Fate::kDelivered;
  Time sent;     // when it entered the link
  Time arrival;  // when it left the link or was dropped
  Duration sojourn{0};
  bool duplicate = false;  // a second copy that follows the first

  bool delivered() const { return fate == Fate::kDelivered; }
};

}  // namespace lidar::link
