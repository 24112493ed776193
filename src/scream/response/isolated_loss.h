// SPDX-License-Identifier: LGPL-2.1-or-later
// Draft section "Link layer losses and rate policers", and extension evidence: separates losses of
// a radio from congestion.
#pragma once
#include <algorithm>

#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"

namespace lidar::scream {

/// Returns true if losses show congestion. With the extension, losses at a short queue also show
/// congestion, but a path that carries ECT(1) may have a higher rate of other losses.
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
