// SPDX-License-Identifier: LGPL-2.1-or-later
// The PI2 controller of RFC 9332 (DualQ Coupled AQM), for one queue or for a coupled pair.
#pragma once
#include <memory>

#include "src/base/time.h"
#include "src/link/aqm.h"
#include "src/link/queue.h"
#include "src/link/random.h"

namespace lidar::link {

struct Pi2Config {
  Duration target = std::chrono::milliseconds{15};  // of the classic queue's delay
  Duration t_update = std::chrono::milliseconds{16};
  double alpha_per_s = 0.16;  // integral gain
  double beta_per_s = 3.2;    // proportional gain
  double k = 2;               // coupling of the L4S signal to the classic one
  Duration t_shift = std::chrono::milliseconds{50};  // how far L4S goes ahead in a pair of queues
  Duration low = std::chrono::microseconds{475};     // L4S's own ramp
  Duration high = std::chrono::microseconds{1000};
  bool knows_l4s = true;  // false, in one queue: ECT(1) is marked as rarely as ECT(0)
};

/// The base probability p', in steps of t_update however seldom it is asked.
class PiController {
 public:
  explicit PiController(const Pi2Config& config) : config_(config) {}
  /// `qdelay`: the classic queue's delay at `now`, taken for every step since the last call.
  void Update(Time now, Duration qdelay);
  double p() const { return p_; }

 private:
  Pi2Config config_;
  double p_ = 0;
  Duration previous_{0};
  Time next_{};
  bool started_ = false;
};

/// A single queue. Classic packets are marked (ECT(0)) or dropped with p'^2. ECT(1) is marked with
/// k p', or with p'^2 without L4S.
std::unique_ptr<Aqm> Pi2Aqm(const Pi2Config& config, Random random);

/// Two queues: L4S (ECT(1), CE) with its own ramp and the coupled signal, and classic. The one
/// whose head waits longer goes first, L4S ahead by t_shift.
std::unique_ptr<Queue> DualPi2Queue(const Pi2Config& config, Random random);

}  // namespace lidar::link
