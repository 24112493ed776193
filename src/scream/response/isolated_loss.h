// SPDX-License-Identifier: LGPL-2.1-or-later
// Extension evidence: separates losses of a radio from congestion.
#pragma once
#include <algorithm>

#include "src/scream/model/path_model.h"
#include "src/scream/parameters.h"
#include "src/scream/response/reference_window.h"

namespace lidar::scream {

inline LossTolerance TolerateLoss(const Parameters& p, const PathModel& path) {
  LossTolerance tolerance{p.loss_rate_threshold, false};
  if (!p.extensions.evidence) return tolerance;
  tolerance.queue_at_loss =
      path.queue_delay().qdelay() > p.isolated_loss_qdelay || path.loss_context().AtFullQueue();
  if (p.ecn == Ecn::kEct1 && path.ecn().state() == EcnState::kCapable)
    tolerance.loss_rate_threshold = std::max(p.loss_rate_threshold, p.isolated_loss_threshold);
  return tolerance;
}

}  // namespace lidar::scream
