// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once
#include "src/tools/apps/worker/lease_record.h"

namespace lidar::worker {

/// Returns the progress up to scan `number`. The position of the scan is `number` metres ahead.
inline Progress Scan(std::uint64_t number) {
  Progress progress;
  progress.pose = {static_cast<double>(number), 0, 0, 0, 0, 0, 1};
  progress.scan = progress.from = number;
  return progress;
}

}  // namespace lidar::worker
