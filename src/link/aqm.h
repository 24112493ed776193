// SPDX-License-Identifier: LGPL-2.1-or-later
// Active queue management: which packets a queue marks or drops to say that it grows.
#pragma once
#include <memory>

#include "src/base/time.h"
#include "src/link/packet.h"
#include "src/link/random.h"

namespace lidar::link {

enum class Verdict { kPass, kMark, kDrop };

/// Asked once a packet, as it leaves the queue. Marks are for packets whose ECN bits allow them.
class Aqm {
 public:
  virtual ~Aqm() = default;
  virtual Verdict OnDequeue(Time now, Duration sojourn, const Packet& packet) = 0;
};

/// Marks no packet: the queue limit alone signals.
std::unique_ptr<Aqm> NoAqm();
/// Marks every ECT(1) packet that waited longer than `threshold`.
std::unique_ptr<Aqm> StepAqm(Duration threshold);
/// Marks ECT(1) packets with a probability that rises from 0 at `low` to 1 at `high`.
std::unique_ptr<Aqm> RampAqm(Duration low, Duration high, Random random);

}  // namespace lidar::link
