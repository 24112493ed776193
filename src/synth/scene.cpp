// SPDX-License-Identifier: LGPL-2.1-or-later
#include "src/synth/scene.h"

#include "src/synth/scene_makers.h"

namespace lidar::synth {

std::unique_ptr<Scene> Scene::Make(SceneKind kind, std::uint64_t seed) {
  switch (kind) {
    case SceneKind::kTunnel:
      return MakeTunnel(seed);
    case SceneKind::kField:
      return MakeField(seed);
    case SceneKind::kTown:
      return MakeTown(seed);
    case SceneKind::kStreet:
      break;
  }
  return MakeStreet(seed);
}

}  // namespace lidar::synth
