// SPDX-License-Identifier: LGPL-2.1-or-later
// What the link model sees of a packet, and what became of it.
#pragma once
#include <cstdint>

#include "src/base/time.h"
#include "src/base/units.h"

namespace lidar::link {

/// The two ECN bits of the IP header (RFC 3168), with their values on the wire.
enum class Ecn : std::uint8_t { kNotEct = 0, kEct1 = 1, kEct0 = 2, kCe = 3 };

struct Packet {
  DataSize size;  // on the wire, IP header included
  Ecn ecn = Ecn::kNotEct;
  std::uint64_t id = 0;  // the caller's: the model hands it back untouched
};

enum class Fate : std::uint8_t {
  kDelivered,
  kLost,       // random loss
  kQueueFull,  // tail drop
  kAqmDropped  // an AQM that signals packets without ECN by dropping them
};

/// A packet at the end of its way. `sojourn` runs from the arrival in the queue to the start of
/// transmission; where the packet was dropped, to the drop.
struct Outcome {
  Packet packet;  // with the ECN bits it left with
  Fate fate = Fate::kDelivered;
  Time sent;     // entered the link
  Time arrival;  // left it; of a dropped packet, the time of the drop
  Duration sojourn{0};
  bool duplicate = false;  // a second copy, right behind the first

  bool delivered() const { return fate == Fate::kDelivered; }
};

}  // namespace lidar::link
