// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/scream/parameters.h"

namespace lidar::scream {

Parameters Parameters::Draft() {
  Parameters p;
  p.reduce_jitter = false;
  p.clock_drift = false;
  p.link_layer_loss = false;
  p.undershoot_remedy = false;
  p.extensions = {false, false, false, false};
  p.pacing_catch_up = Duration{0};
  return p;
}

}  // namespace lidar::scream
