// SPDX-License-Identifier: LGPL-2.1-or-later
// Active queue management: decides which packets a growing queue marks or drops.
#pragma once
#include <memory>

#include "src/base/time.h"
#include "src/link/packet.h"
#include "src/link/random.h"

namespace lidar::link {

enum class Verdict { kPass, kMark, kDrop };

/// Called once a packet, as the packet leaves the queue. Only packets whose ECN bits allow it are
/// marked.
class Aqm {
 public:
  virtual ~Aqm() = default;
  virtual Verdict OnDequeue(Time now, Duration sojourn, const Packet& packet) = 0;
};

/// Marks no packet: only the queue limit drops packets.
std::unique_ptr<Aqm> NoAqm();
/// Marks every ECT(1) packet that waited longer than `threshold`.
std::unique_ptr<Aqm> StepAqm(Duration threshold);
/// Marks ECT(1) packets. The probability rises from 0 at a delay of `low` to 1 at `high`.
std::unique_ptr<Aqm> RampAqm(Duration low, Duration high, Random random);

}  // namespace lidar::link
