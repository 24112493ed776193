// SPDX-License-Identifier: LGPL-2.1-or-later
// Draft section "Link layer losses and rate policers", and extension evidence: distinguishes losses
// on a radio link from congestion.
#pragma once
#include <algorithm>

#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"

namespace lidar::scream {

/// Returns true if losses show congestion, because the queue is long or losses are frequent. With
/// the extension evidence, a shorter queue is enough. On a path that carries ECT(1), the extension
/// tolerates a higher rate of losses without a queue.
inline bool LossIsCongestion(const Parameters& p, const PathModel& path) {
  const QueueDelay& queue = path.queue_delay();
  if (!p.link_layer_loss || queue.qdelay_avg() > p.qdelay_target_lo / 4) return true;
  double tolerated = p.loss_rate_threshold;
  if (p.extensions.evidence) {
    if (queue.qdelay() > p.isolated_loss_qdelay || path.loss_context().AtFullQueue()) return true;
    if (p.ecn == Ecn::kEct1 && path.ecn().state() == EcnState::kCapable)
      tolerated = std::max(tolerated, p.isolated_loss_threshold);
  }
  return path.loss_rate() > tolerated;
}

}  // namespace lidar::scream
