// SPDX-License-Identifier: LGPL-2.1-or-later
// The PI2 controller of RFC 9332 (DualQ Coupled AQM), for one queue or two coupled queues.
#pragma once
#include <memory>

#include "src/base/time.h"
#include "src/link/aqm.h"
#include "src/link/queue.h"
#include "src/link/random.h"

namespace lidar::link {

struct Pi2Config {
  Duration target = std::chrono::milliseconds{15};  // delay of the classic queue
  Duration t_update = std::chrono::milliseconds{16};
  double alpha_per_s = 0.16;  // integral gain
  double beta_per_s = 3.2;    // proportional gain
  double k = 2;               // factor from the base probability to that of the L4S signal
  Duration t_shift = std::chrono::milliseconds{50};  // added to the wait of the L4S queue
  Duration low = std::chrono::microseconds{475};     // ramp of the L4S queue
  Duration high = std::chrono::microseconds{1000};
  bool knows_l4s = true;  // false: a single queue marks ECT(1) as rarely as ECT(0)
};

/// Computes the base probability p', which changes once every t_update.
class PiController {
 public:
  explicit PiController(const Pi2Config& config) : config_(config) {}
  /// Updates p' once for each t_update that has passed since the last call. `qdelay` is the delay
  /// of the classic queue at `now`.
  void Update(Time now, Duration qdelay);
  double p() const { return p_; }

 private:
  Pi2Config config_;
  double p_ = 0;
  Duration previous_{0};
  Time next_{};
  bool started_ = false;
};

/// Returns an AQM for a single queue. Classic packets are marked (ECT(0)) or dropped (Not-ECT) with
/// the probability p'^2. ECT(1) packets are marked with the probability k p', or p'^2 if
/// `knows_l4s` is false.
std::unique_ptr<Aqm> Pi2Aqm(const Pi2Config& config, Random random);

/// Returns a pair of queues. The L4S queue, for ECT(1) and CE, marks by a ramp and by the coupled
/// signal. The other queue is classic. The queue whose head has waited longer is served first,
/// where t_shift is added to the wait of the L4S queue.
std::unique_ptr<Queue> DualPi2Queue(const Pi2Config& config, Random random);

}  // namespace lidar::link
