// SPDX-License-Identifier: LGPL-2.1-or-later
// Active queue management: decides which packets are marked or dropped when a queue grows.
#pragma once
#include <memory>

#include "src/base/time.h"
#include "src/link/packet.h"
#include "src/link/random.h"

namespace lidar::link {

enum class Verdict { kPass, kMark, kDrop };

/// OnDequeue() is called once for each packet, when the packet leaves the queue. Only packets whose
/// ECN bits allow it are marked.
class Aqm {
 public:
  virtual ~Aqm() = default;
  virtual Verdict OnDequeue(Time now, Duration sojourn, const Packet& packet) = 0;
};

/// Marks no packets. Only the limit of the queue drops packets.
std::unique_ptr<Aqm> NoAqm();
/// Marks every ECT(1) packet that waited longer than `threshold`.
std::unique_ptr<Aqm> StepAqm(Duration threshold);
/// Marks ECT(1) packets. The probability rises from 0 at a delay of `low` to 1 at `high`.
std::unique_ptr<Aqm> RampAqm(Duration low, Duration high, Random random);

}  // namespace lidar::link
